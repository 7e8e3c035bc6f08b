// SPDX-License-Identifier: MIT
#include "fleet/hub/certificates.h"

#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "tests/support/temporary.h"

namespace framewatch::fleet {
namespace certificates_test {

class Certificates : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists("/usr/bin/openssl")) GTEST_SKIP() << "openssl is not installed";
  }
  std::string path(const char* name) const { return folder_.path(name); }
  bool shell(const std::string& command) const {
    return std::system((command + " >/dev/null 2>&1").c_str()) == 0;  // NOLINT: a test's own words
  }
  test::TemporaryDirectory folder_;
};

TEST_F(Certificates, SignsABuildingsRequest) {
  const Authority authority(path("."));
  ASSERT_EQ(authority.make(), "");
  ASSERT_EQ(make_request("kobe-03", path("k"), path("r")), "");
  ASSERT_EQ(authority.sign("kobe-03", path("r"), path("kobe-03.pem")), "");
  EXPECT_TRUE(shell(fmt::format("openssl verify -purpose sslclient -CAfile {} {}", path("ca.pem"),
                                path("kobe-03.pem"))));
  EXPECT_FALSE(shell(fmt::format("openssl verify -purpose sslserver -CAfile {} {}", path("ca.pem"),
                                 path("kobe-03.pem"))));
  for (const char* key : {"ca.key", "k"}) {
    struct ::stat file {};
    ASSERT_EQ(::stat(path(key).c_str(), &file), 0);
    EXPECT_EQ(file.st_mode & 077, 0U) << key;
  }
}

TEST_F(Certificates, MarksAServerAndItsAddresses) {
  const Authority authority(path("."));
  ASSERT_EQ(authority.make(), "");
  ASSERT_EQ(authority.issue("hub1", {"hub1.example.org", "127.0.0.1"}), "");
  for (const char* check : {"-verify_hostname hub1.example.org", "-verify_ip 127.0.0.1"})
    EXPECT_TRUE(shell(fmt::format("openssl verify -purpose sslserver {} -CAfile {} {}", check,
                                  path("ca.pem"), path("hub1.pem"))))
        << check;
}

TEST_F(Certificates, RefusesARequestWithOtherNames) {
  const Authority authority(path("."));
  ASSERT_EQ(authority.make(), "");
  int number = 0;
  for (const char* subject :
       {"/CN=worker", "/CN=kobe-04", "/O=x/CN=kobe-03", "/CN=kobe-03/CN=worker",
        "/CN=kobe-03+CN=worker", "/CN=kobe-03\\nCN=worker"}) {
    const std::string request = path(fmt::format("r{}", ++number).c_str());
    ASSERT_TRUE(shell(fmt::format(
        "openssl req -newkey ed25519 -nodes -multivalue-rdn -keyout {} -out {} -subj '{}'",
        path("k"), request, subject)))
        << subject;
    EXPECT_NE(authority.sign("kobe-03", request, path("x.pem")), "") << subject;
    EXPECT_FALSE(std::filesystem::exists(path("x.pem")));
  }
  test::write_file(path("noise"), "no request");
  EXPECT_NE(authority.sign("kobe-03", path("noise"), path("x.pem")), "");
  EXPECT_NE(authority.sign("kobe-03", path("absent"), path("x.pem")), "");
}

TEST_F(Certificates, CreatesOnlyOneAuthority) {
  const Authority authority(path("."));
  ASSERT_EQ(authority.make(), "");
  const std::string before = test::read_file(path("ca.key"));
  EXPECT_NE(authority.make(), "");
  EXPECT_EQ(test::read_file(path("ca.key")), before);
  const auto names = folder_.names();
  EXPECT_EQ(std::count_if(names.begin(), names.end(),
                          [](const std::string& n) { return n.starts_with(".openssl"); }),
            0);
}

}  // namespace certificates_test
}  // namespace framewatch::fleet
