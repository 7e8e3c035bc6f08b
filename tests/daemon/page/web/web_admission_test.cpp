// SPDX-License-Identifier: MIT
#include "daemon/page/web/web_admission.h"

#include <string>

#include <gtest/gtest.h>

#include "daemon/page/web/serve_command.h"

namespace framewatch::daemon {
namespace web_admission_test {

WebRequest get(const std::string& path, const std::string& host) {
  return {"GET", path, host, "", "", "", ""};
}

TEST(WebAdmission, ChecksHostMethodTokenAndOrigin) {
  WebSettings s;
  s.token = "0123456789abcdef";
  EXPECT_TRUE(problems(s).empty());
  for (const char* host : {"127.0.0.1:8080", "localhost", "[::1]:9"})
    EXPECT_EQ(admit(s, get("/", host)), Admission::served) << host;
  for (const char* host : {"evil.example", "", "127.0.0.1.evil.example", "[::1", "localhost.x:80"})
    EXPECT_EQ(admit(s, get("/", host)), Admission::wrong_host) << host;
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "POST", "PATCH"}) {
    WebRequest r = get("/", "localhost");
    r.method = method;
    EXPECT_EQ(admit(s, r), Admission::wrong_method) << method;
  }
  for (const char* path : {"/acknowledge", "/baseline", "/session"}) {
    WebRequest verb = get(path, "localhost:8080");
    verb.method = "POST";
    EXPECT_EQ(admit(s, verb), Admission::no_token);
    verb.cookie = "0123456789abcdeF";
    EXPECT_EQ(admit(s, verb), Admission::no_token);
    verb.cookie = s.token;
    EXPECT_EQ(admit(s, verb), Admission::served);
    verb.origin = "http://localhost:8080";
    EXPECT_EQ(admit(s, verb), Admission::served);
    verb.origin = "http://evil.example";
    EXPECT_EQ(admit(s, verb), Admission::wrong_origin);
  }
}

TEST(WebAdmission, RequiresATokenFromOtherAddresses) {
  WebSettings s;
  s.address = "192.168.1.7";
  EXPECT_EQ(problems(s).size(), 1u);
  s.token = "short";
  EXPECT_EQ(problems(s).size(), 1u);
  s.token = "0123456789abcdef";
  EXPECT_TRUE(problems(s).empty());
  WebRequest r = get("/page.js", "192.168.1.7:8080");
  EXPECT_EQ(admit(s, r), Admission::no_token);
  r.authorization = "Bearer " + s.token;
  EXPECT_EQ(admit(s, r), Admission::served);
  r.host = "tower.example:8080";
  EXPECT_EQ(admit(s, r), Admission::wrong_host);
  s.hosts = {"tower.example"};
  EXPECT_EQ(admit(s, r), Admission::served);
}

TEST(ServeCommand, RefusesToServeOthersWithoutAToken) {
  ServeArguments a;
  a.config = FRAMEWATCH_SOURCE_DIR "/configs/table_two_story.toml";
  a.address = "0.0.0.0";
  EXPECT_EQ(serve(a), 2);
  a.token_file = "/nowhere";
  EXPECT_EQ(serve(a), 2);
}

}  // namespace web_admission_test
}  // namespace framewatch::daemon
