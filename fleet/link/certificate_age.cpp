#include "fleet/link/certificate_age.h"

#include <chrono>
#include <optional>
#include <thread>

#include <fmt/core.h>

#include "daemon/base/process.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kOpenssl = "/usr/bin/openssl";
constexpr std::chrono::milliseconds kPause{2};
constexpr int kMaxLooks = 1000;

}  // namespace

std::string expired(const std::string& certificate) {
  std::string error;
  auto process = daemon::ChildProcess::start(
      {"x509", "-in", certificate, "-noout", "-out", "/dev/null", "-checkend", "0"}, error,
      kOpenssl, "/dev/null");
  for (int i = 0; process && i < kMaxLooks; ++i) {
    if (const std::optional<int> status = process->ended())
      return *status == 1 ? fmt::format("{} expired, or the host's clock is wrong", certificate)
                          : "";
    std::this_thread::sleep_for(kPause);
  }
  return {};
}

}  // namespace framewatch::fleet
