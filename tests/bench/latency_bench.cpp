// SPDX-License-Identifier: MIT
// Measures the time from the arrival of a sample on the socket to the publication of its estimate,
// live over LCM's multicast on this machine. A child process plays the building; this process
// estimates.
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "daemon/monitor/live/run_command.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/lcm_source.h"
#include "tests/bench/cpu_clock.h"
#include "tests/bench/shaken_building.h"

namespace framewatch::bench {
namespace {

constexpr int kRate_hz = 100;
constexpr int kSteadyFrom = 1100;  // windows; the first tuning is over
constexpr const char* kUrl = "udpm://239.255.76.67:7667?ttl=0";

daemon::Config live_config(int stories, int bays) {
  daemon::Config config;
  config.path = "bench";
  config.pipeline = building(stories, bays);
  for (std::size_t a = 0; a < config.pipeline.axes.size(); ++a)
    config.sources.push_back({"ACCEL", static_cast<int>(a), 0});
  config.lcm.url = kUrl;
  return config;
}

/// Sends every axis as a node, every 10 ms, until killed.
[[noreturn]] void be_the_building(const Eigen::MatrixXd& accel) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::string error;
  const auto lcm = drivers::open_lcm(kUrl, {}, error);
  if (!lcm) ::_exit(2);
  auto due = std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
  for (Eigen::Index t = 0; t < accel.rows(); ++t) {
    std::this_thread::sleep_until(due);
    due += std::chrono::milliseconds(1000 / kRate_hz);
    for (Eigen::Index a = 0; a < accel.cols(); ++a) {
      drivers::SensorNodeSample sample{estimator::from_microseconds(10'000LL * t),
                                       t,
                                       static_cast<std::int32_t>(a),
                                       {accel(t, a), 0, 0}};
      const std::vector<std::uint8_t> bytes = drivers::encode_accel(sample);
      lcm->publish("ACCEL", bytes.data(), static_cast<unsigned>(bytes.size()));
    }
  }
  ::_exit(0);
}

int run(int stories, int bays, int seconds) {
  const daemon::Config config = live_config(stories, bays);
  const Eigen::MatrixXd accel = shaken(config.pipeline, seconds * kRate_hz);
  std::string error;
  const auto lcm = drivers::open_lcm(kUrl, config.lcm.reception, error);
  if (!lcm) {
    std::fprintf(stderr, "latency_bench: %s\n", error.c_str());
    return 2;
  }
  daemon::LiveEstimation live(config, *lcm);
  std::fflush(stdout);  // or the child would print it again
  const pid_t child = ::fork();
  if (child == 0) be_the_building(accel);
  std::vector<double> latency_us;
  std::int64_t windows = 0;
  while (true) {
    if (!live.poll(1000)) break;
    if (live.estimation().windows() > windows) {
      windows = live.estimation().windows();
      if (windows > kSteadyFrom) latency_us.push_back(1e6 * live.state().latency_s);
    } else if (::waitpid(child, nullptr, WNOHANG) != 0) {
      break;
    }
  }
  std::printf(
      "%dx%d bays, %3d stories, %4zu messages per instant: median %7.0f us, p99 %7.0f us, "
      "largest %7.0f us over %zu estimates; %lld messages lost\n",
      bays, bays, stories, config.pipeline.axes.size(), quantile(latency_us, 0.5),
      quantile(latency_us, 0.99), quantile(latency_us, 1), latency_us.size(),
      static_cast<long long>(live.estimation().intake().lost()));
  return latency_us.empty() ? 1 : 0;
}

}  // namespace
}  // namespace framewatch::bench

/// latency_bench [seconds]: to be run in tests/support/private-network
int main(int argc, char** argv) {
  const int seconds = argc > 1 ? std::atoi(argv[1]) : 25;
  int worst = 0;
  worst = std::max(worst, framewatch::bench::run(2, 1, seconds));
  worst = std::max(worst, framewatch::bench::run(5, 1, seconds));
  worst = std::max(worst, framewatch::bench::run(20, 3, seconds));
  return worst;
}
