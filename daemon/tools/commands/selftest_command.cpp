// SPDX-License-Identifier: MIT
#include "daemon/tools/commands/selftest_command.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/printable.h"
#include "daemon/base/process.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/tools/demo/demo_scenario.h"
#include "daemon/tools/demo/demo_view.h"
#include "drivers/files/partial_file.h"
#include "drivers/lcm/lcm_source.h"
#include "estimator/numeric/kernels.h"

namespace framewatch::daemon {
namespace {

constexpr int kDelivery_ms = 1000;
constexpr double kShaken_s = 15;
constexpr double kMinSpeed = 3;  // multiple of real time; leaves room for bursts and other programs
constexpr std::size_t kDisk_bytes = 1 << 20;
constexpr double kSlowDisk_s = 1;
constexpr std::int64_t kLittleDisk_bytes = 1'000'000'000;

const char* instruction_set() {
  if (estimator::kernels::in_use == estimator::kernels::x86_64_v4()) return "AVX-512";
  if (estimator::kernels::in_use == estimator::kernels::x86_64_v3()) return "AVX2";
  return "no vector instructions beyond the machine's least";
}

/// Returns an empty text, or the reason of the failure.
std::string write_and_sync(const std::string& path) {
  drivers::PartialFile file;
  if (!file.open(path)) return file.error();
  const std::string bytes(kDisk_bytes, 'x');
  std::string problem;
  if (::write(file.descriptor(), bytes.data(), bytes.size()) !=
          static_cast<ssize_t>(bytes.size()) ||
      ::fsync(file.descriptor()) != 0)
    problem = errno != 0 ? std::strerror(errno) : "not everything was taken";
  return problem;
}

void print_text(const std::vector<MachineCheck>& checks) {
  for (const MachineCheck& check : checks) {
    fmt::print("{} {:<10} {}\n",
               check.good ? toned(Tone::good, "ok  ", stdout) : toned(Tone::bad, "bad ", stdout),
               check.name, check.found);
    if (!check.good) fmt::print("{:15} -> {}\n", "", check.remedy);
  }
}

void print_json(const std::vector<MachineCheck>& checks) {
  nlohmann::json out = nlohmann::json::array();
  for (const MachineCheck& check : checks)
    out.push_back({{"check", check.name},
                   {"good", check.good},
                   {"found", check.found},
                   {"remedy", check.remedy}});
  fmt::print("{}\n", out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

MachineCheck check_multicast(const LcmSettings& settings) {
  MachineCheck check{false, "multicast", settings.url};
  const auto lcm = drivers::open_lcm(settings.url, settings.reception, check.remedy);
  if (!lcm) return check;
  const std::string channel = settings.prefix + "SELFTEST";
  drivers::LcmSource source(*lcm, {channel}, 10,
                            [&](const drivers::LcmMessage&) { check.good = true; });
  lcm->publish(channel, "selftest", 8);
  const std::int64_t began_us = steady_clock_us();
  if (!source.handle(kDelivery_ms)) check.good = false;
  if (check.good)
    check.found += fmt::format(", delivered in {:.1f} ms",
                               1e-3 * static_cast<double>(steady_clock_us() - began_us));
  else
    check.remedy = "messages do not come back: check the firewall and the multicast route";
  return check;
}

MachineCheck check_buffer(const LcmSettings& settings) {
  const int wanted = settings.reception.receive_buffer_bytes;
  int got = 0;
  socklen_t size = sizeof got;
  const int probe = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ::setsockopt(probe, SOL_SOCKET, SO_RCVBUF, &wanted, sizeof wanted);
  ::getsockopt(probe, SOL_SOCKET, SO_RCVBUF, &got, &size);
  ::close(probe);
  got /= 2;  // the kernel returns twice the requested value
  MachineCheck check{got >= wanted, "buffers", fmt::format("{} of {} bytes", got, wanted)};
  if (!check.good)
    check.remedy = fmt::format(
        "bursts are lost: set sysctl net.core.rmem_max={} (permanently: in a file in "
        "/etc/sysctl.d)",
        wanted);
  return check;
}

MachineCheck check_clock() {
  timex clock{};
  const bool synchronised = ::ntp_adjtime(&clock) != TIME_ERROR;
  MachineCheck check{synchronised, "clock",
                     synchronised
                         ? fmt::format("synchronised, off by {} us at most", clock.maxerror)
                         : "no time synchronization is running"};
  if (!synchronised)
    check.remedy = "install chrony or systemd-timesyncd: CAN samples are stamped with this clock";
  return check;
}

MachineCheck check_estimate() {
  const Scenario scenario = demo_scenario();
  struct : EstimationListener {
    void on_estimate(const estimator::WindowEstimate& estimate) override { newest = estimate; }
    std::optional<estimator::WindowEstimate> newest;
  } seen;
  Estimation estimation(scenario.config, {}, &seen);
  Simulation simulation(scenario);
  std::int64_t spent_us = 0;
  while (simulation.time_s() < kShaken_s) {
    const std::vector<double>& values = simulation.next();
    const estimator::Time time =
        estimator::from_microseconds(std::llround(1e6 * simulation.time_s()));
    const std::int64_t began_us = steady_clock_us();
    for (std::size_t axis = 0; axis < values.size(); ++axis)
      if (std::isfinite(values[axis]))
        estimation.sample({time, static_cast<int>(axis), values[axis]});
    spent_us += steady_clock_us() - began_us;
  }
  const estimator::ParameterTable table(scenario.config.pipeline.structure);
  double worst = 0;
  int found = 0;
  for (int p = 0; seen.newest && p < table.size(); ++p) {
    const auto at = static_cast<std::size_t>(p);
    if (table[p].kind != estimator::ParameterKind::frame_stiffness ||
        seen.newest->reason[at] != estimator::Observability::observable)
      continue;
    worst = std::max(worst, std::abs(seen.newest->value[at] / scenario.truth[p] - 1));
    ++found;
  }
  const double speed = 1e6 * kShaken_s / static_cast<double>(spent_us);
  const bool right = found > 0 && worst <= DemoView::kFrameLimit_ratio;
  MachineCheck check{right && speed >= kMinSpeed, "estimate",
                     fmt::format("{} frames of a virtual building within {:.2f} %, {:.0f} times as "
                                 "fast as they come, {}",
                                 found, 100 * worst, speed, instruction_set())};
  if (!right)
    check.remedy = "the program computes wrong results on this machine: do not use it here";
  if (right && !check.good) check.remedy = "the machine is too slow or too busy";
  return check;
}

MachineCheck check_disk(const std::string& directory) {
  const std::string path = directory + "/.framewatch-selftest";
  const std::int64_t began_us = steady_clock_us();
  const std::string problem = write_and_sync(path);
  const double seconds = 1e-6 * static_cast<double>(steady_clock_us() - began_us);
  const std::int64_t left = disk_free_bytes(path);
  MachineCheck check{false, "disk",
                     fmt::format("{}: {:.1f} GB free, 1 MiB written in {:.3f} s", directory,
                                 1e-9 * static_cast<double>(left), seconds)};
  if (!problem.empty()) {
    check.found = directory;
    check.remedy = problem + ": state and records need a writable directory";
  } else if (left < kLittleDisk_bytes) {
    check.remedy = "make room: less than 1 GB is left";
  } else if (seconds > kSlowDisk_s) {
    check.remedy = "the disk is slow: state is written late, records wait in memory";
  }
  check.good = check.remedy.empty();
  return check;
}

int selftest(const SelftestArguments& a) {
  LcmSettings lcm;
  if (!a.config.empty()) {
    std::vector<ConfigProblem> problems;
    const auto config = load_config(a.config, problems);
    print_problems(problems);
    if (!config) return kBadInput;
    lcm = config->lcm;
  }
  const std::vector<MachineCheck> checks{check_multicast(lcm), check_buffer(lcm), check_clock(),
                                         check_estimate(), check_disk(a.directory)};
  if (a.json)
    print_json(checks);
  else
    print_text(checks);
  const bool good =
      std::all_of(checks.begin(), checks.end(), [](const MachineCheck& c) { return c.good; });
  return good ? 0 : kFailed;
}

}  // namespace framewatch::daemon
