// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/page/web/web_server.h"
#include "tests/daemon/page/web/served.h"

namespace framewatch::daemon {
namespace web_requests_test {

using test::ask, test::Served;

constexpr const char* kCookie = "Cookie: framewatch=0123456789abcdef\r\n";

std::string get(const std::string& path, const std::string& host = "127.0.0.1") {
  return "GET " + path + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n";
}

std::string with(const std::string& line, const std::string& headers) {
  return line + " HTTP/1.1\r\nHost: 127.0.0.1\r\n" + headers + "\r\n";
}

struct Case {
  const char* what;
  std::string request;
  const char* status;  ///< empty: closed without an answer
};

/// Returns the three digits of the status of an HTTP answer, or an empty text if `answer` does not
/// begin as one.
std::string status_of(const std::string& answer) {
  return answer.starts_with("HTTP/1.1 ") ? answer.substr(9, 3) : "";
}

std::vector<Case> foreign_requests() {
  return {
      {"out of the folder", get("/../../etc/passwd"), "404"},
      {"encoded", get("/%2e%2e/%2e%2e/etc/passwd"), "404"},
      {"out of the sessions", get("/session/../../../etc/passwd/report.html"), "404"},
      {"encoded slashes", get("/session/..%2f..%2fetc/report.html"), "404"},
      {"a byte of zero", get("/session/a%00/../report.html"), "404"},
      {"another name", get("/building.json", "evil.example:8099"), "421"},
      {"no name", "GET / HTTP/1.0\r\n\r\n", "421"},
      {"a name with a dot", get("/building.json", "localhost."), "421"},
      {"a longer name", get("/building.json", "127.0.0.1.evil.example"), "421"},
      {"two names", with("GET /healthz", "Host: evil.example\r\n"), "400"},
      {"an address for a path", get("http://evil.example/building.json"), "400"},
      {"its own address for a path", get("http://127.0.0.1/building.json"), "400"},
      {"no path", with("OPTIONS *", ""), "400"},
      {"PUT", with("PUT /", ""), "405"},
      {"DELETE", with("DELETE /acknowledge?id=1", kCookie), "405"},
      {"OPTIONS", with("OPTIONS /", ""), "405"},
      {"TRACE", with("TRACE /", ""), "405"},
      {"CONNECT", with("CONNECT /", ""), "405"},
      {"no method", with(std::string(5000, 'A') + " /", ""), "405"},
      {"acknowledged by GET", with("GET /acknowledge?id=1", kCookie), "404"},
      {"no token", with("POST /acknowledge?id=1", ""), "403"},
      {"from another page",
       with("POST /baseline", std::string(kCookie) + "Origin: http://evil.example\r\n"), "403"},
      {"from nowhere", with("POST /baseline", std::string(kCookie) + "Origin: null\r\n"), "403"},
      {"from another port",
       with("POST /baseline", std::string(kCookie) + "Origin: http://127.0.0.1:9\r\n"), "403"},
      {"a body", with("GET /", "Content-Length: 5\r\n"), "413"},
      {"a body that does not come",
       with("POST /baseline", std::string(kCookie) + "Content-Length: 99999999999999\r\n"), "413"},
      {"chunks",
       with("POST /baseline", std::string(kCookie) + "Transfer-Encoding: chunked\r\n") +
           "FFFFFFFFFFFFFFFF\r\nAAAA",
       "413"},
      {"two lengths",
       with("POST /baseline",
            std::string(kCookie) + "Content-Length: 0\r\nTransfer-Encoding: chunked\r\n"),
       "413"},
      {"less than no body", with("POST /baseline", "Content-Length: -1\r\n"), "400"},
      {"a long header", with("GET /", "X: " + std::string(100'000, 'A') + "\r\n"), "431"},
      {"a long path", get("/" + std::string(100'000, 'a')), "414"},
      {"nothing like HTTP", "hello\r\n\r\n", ""},
  };
}

TEST_F(Served, RefusesForeignRequests) {
  for (const Case& c : foreign_requests()) {
    const std::string answer = ask(server_.port(), c.request);
    EXPECT_EQ(status_of(answer), c.status) << c.what << "\n" << answer.substr(0, 300);
    EXPECT_EQ(answer.find("root:"), std::string::npos) << c.what;
  }
  view_.flush();
  EXPECT_TRUE(published_.empty());
  EXPECT_EQ(status_of(ask(server_.port(), get("/healthz"))), "200");
}

TEST_F(Served, RefusesBytesBehindARequest) {
  // A proxy takes this for the body of the first request.
  for (const std::string& first :
       {get("/healthz"), with("GET /healthz", "Connection: keep-alive\r\n"),
        with("POST /baseline", "Content-Length: 60\r\n"),
        with("POST /baseline", "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n") +
            "0\r\n\r\n"}) {
    const std::string answer = ask(server_.port(), first + get("/building.json"));
    EXPECT_NE(answer.find("Connection: close"), std::string::npos);
    EXPECT_EQ(answer.find("parameters"), std::string::npos) << first;
    EXPECT_EQ(answer.find("HTTP/1.1", 1), std::string::npos) << first;
  }
}

TEST_F(Served, AnswersHeadRequestsWithoutABody) {
  for (const char* path : {"/", "/events", "/metrics"}) {
    const std::string answer = ask(server_.port(), with(std::string("HEAD ") + path, ""));
    EXPECT_EQ(status_of(answer), "200") << path;
    EXPECT_TRUE(answer.ends_with("\r\n\r\n")) << path << answer;
  }
}

}  // namespace web_requests_test
}  // namespace framewatch::daemon
