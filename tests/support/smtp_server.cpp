// SPDX-License-Identifier: MIT
#include "tests/support/smtp_server.h"

#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <thread>

namespace framewatch::test {
namespace {

constexpr std::chrono::milliseconds kLookForPort{20};
constexpr int kLooks = 1500;  // 30 s

}  // namespace

SmtpServer::SmtpServer(const std::vector<std::string>& options) {
  std::vector<std::string> arguments = {FRAMEWATCH_SOURCE_DIR "/tests/support/smtp-server",
                                        folder_.path("")};
  arguments.insert(arguments.end(), options.begin(), options.end());
  process_.emplace(arguments);
  for (int i = 0; i < kLooks && port_ == 0; ++i) {
    std::this_thread::sleep_for(kLookForPort);
    port_ = std::atoi(read_file(folder_.path("port")).c_str());
  }
  if (port_ == 0) throw std::runtime_error("no mail server can be started");
}

TestCertificate::TestCertificate(const TemporaryDirectory& folder)
    : certificate(folder.path("certificate")), key(folder.path("key")) {
  const std::string make =
      "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -days 2 -subj "
      "/CN=test -addext subjectAltName=IP:127.0.0.1 -keyout " +
      key + " -out " + certificate + " 2>/dev/null";
  if (std::system(make.c_str()) != 0) throw std::runtime_error("openssl makes no certificate");
}

}  // namespace framewatch::test
