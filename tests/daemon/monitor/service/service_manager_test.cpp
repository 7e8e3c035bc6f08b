// SPDX-License-Identifier: MIT
#include "daemon/monitor/service/service_manager.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/config/config.h"
#include "daemon/monitor/service/progress_watch.h"
#include "tests/support/child.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace service_manager_test {

constexpr int kLongestWait_ms = 20'000;
constexpr int kWatchdog_us = 1'000'000;

/// The end of a service manager's socket.
class Listener {
 public:
  explicit Listener(const std::string& path) : socket_(::socket(AF_UNIX, SOCK_DGRAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof address.sun_path - 1);
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~Listener() { ::close(socket_); }
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Returns the next datagram; empty if none comes in that time.
  std::string next(int timeout_ms) {
    pollfd waiting{socket_, POLLIN, 0};
    if (::poll(&waiting, 1, timeout_ms) <= 0) return "";
    std::string text(4096, '\0');
    const ssize_t size = ::recv(socket_, text.data(), text.size(), 0);
    text.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    return text;
  }
  /// Returns true if a datagram comes that begins with `beginning`.
  bool hears(const std::string& beginning) {
    for (std::string text = next(kLongestWait_ms); !text.empty(); text = next(kLongestWait_ms))
      if (text.starts_with(beginning)) return true;
    return false;
  }

 private:
  int socket_;
};

TEST(ServiceManager, IsNotifiedOfEveryStepOfARun) {
  const test::TemporaryDirectory directory;
  const std::string config = directory.path("b.toml");
  test::write_file(config, test::read_file(test::table_config()));
  Listener systemd(directory.path("notify"));
  test::Child daemon({"/usr/bin/env", "NOTIFY_SOCKET=" + directory.path("notify"),
                      "WATCHDOG_USEC=" + std::to_string(kWatchdog_us), FRAMEWATCH_PROGRAM, "run",
                      config, "--url", "memq://", "--quiet"});
  EXPECT_TRUE(systemd.hears("READY=1"));
  EXPECT_TRUE(systemd.hears("STATUS=waiting for the first sample"));
  // Idle, and well: fed more often than the timeout.
  for (int i = 0; i < 5; ++i) {
    const std::int64_t began_us = steady_clock_us();
    EXPECT_TRUE(systemd.hears("WATCHDOG=1"));
    EXPECT_LT(steady_clock_us() - began_us, kWatchdog_us);
  }
  test::write_file(config, test::read_file(config) + "\n[watch]\n");
  daemon.signal(SIGHUP);
  EXPECT_TRUE(systemd.hears("RELOADING=1\nMONOTONIC_USEC="));
  EXPECT_TRUE(systemd.hears("READY=1"));
  EXPECT_TRUE(systemd.hears("WATCHDOG=1"));
  daemon.signal(SIGSTOP);
  while (systemd.next(kWatchdog_us / 1000) != "") {
  }
  EXPECT_EQ(systemd.next(2 * kWatchdog_us / 1000), "");  // a hung program sends nothing
  daemon.signal(SIGCONT);
  EXPECT_TRUE(systemd.hears("WATCHDOG=1"));
  daemon.signal(SIGTERM);
  EXPECT_TRUE(systemd.hears("STOPPING=1"));
  EXPECT_EQ(daemon.wait(), 0);
}

estimator::PipelineCounters counters(std::int64_t received, std::int64_t late, std::int64_t sets) {
  estimator::PipelineCounters c;
  c.sample_sets = sets;
  c.axes.resize(2);
  c.axes[1].received = received;
  c.axes[1].late = late;
  return c;
}

/// Returns true if the estimator was well all the time; `step` sets the counters every 0.1 s.
template <typename Step>
bool well_for(ProgressWatch& watch, std::int64_t& now_us, double seconds, const Step& step) {
  bool well = true;
  for (int i = 0; i < static_cast<int>(10 * seconds); ++i)
    well = watch.well(step(), now_us += 100'000) && well;
  return well;
}

TEST(ProgressWatch, FailsOnlyIfStuck) {
  ProgressWatch watch;
  std::int64_t now_us = 0, n = 0;
  const double longest_s = 1e-6 * ProgressWatch::kLongest_us;
  EXPECT_TRUE(well_for(watch, now_us, 60, [&] { return counters(0, 0, 0); }));
  EXPECT_TRUE(well_for(watch, now_us, 60, [&] { return ++n, counters(n, 0, n); }));
  // Idle for an hour, then the first samples, without an instant yet.
  const std::int64_t sets = n;
  EXPECT_TRUE(well_for(watch, now_us, 3600, [&] { return counters(n, 0, sets); }));
  EXPECT_TRUE(well_for(watch, now_us, longest_s - 1, [&] { return counters(++n, 0, sets); }));
  // An incomplete burst followed by silence counts as idle.
  EXPECT_TRUE(well_for(watch, now_us, 60, [&] { return counters(n, 0, sets); }));
  // Refused samples are no progress.
  std::int64_t late = 0;
  EXPECT_TRUE(well_for(watch, now_us, 60, [&] { return ++late, counters(n + late, late, sets); }));
  EXPECT_FALSE(
      well_for(watch, now_us, 2 * longest_s, [&] { return ++n, counters(n + late, late, sets); }));
}

TEST(ProgressWatch, OneSensorOfTenIsEnough) {
  std::vector<ConfigProblem> problems;
  const auto config = load_config(test::table_config(), problems);
  ASSERT_TRUE(config);
  estimator::Pipeline pipeline(config->pipeline);
  ProgressWatch watch;
  bool well = true;
  for (std::int64_t i = 0; i < 2000; ++i) {
    pipeline.push({estimator::from_microseconds(1'000'000 + 10'000 * i), 3, 0.1});
    well = watch.well(pipeline.counters(), 10'000 * i) && well;
  }
  EXPECT_TRUE(well);
  EXPECT_GT(pipeline.counters().sample_sets, 1000);
}

}  // namespace service_manager_test
}  // namespace framewatch::daemon
