// SPDX-License-Identifier: MIT
// soak: runs months of a building in hours and checks limits.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <fmt/core.h>

#include "tests/soak/soak_run.h"

namespace framewatch::soak {
namespace {

constexpr const char* kUsage = R"(usage: soak DIR [--days N] [--seed N] [--alarms-per-year N]

Runs the demo building for N days (30) as fast as possible: quiet, traffic, two earthquakes, failing
sensors, steps of the clock, stiffness that follows the temperature; no damage. Writes the history to
DIR, which must not exist. Prints a line every day and the results at the end.
exit: 0 all requirements hold, 1 one does not, 2 usage
)";

// Limits.
constexpr double kMaxGrowth_bytes = 1 << 20;
constexpr double kSumError = 1e-9;
constexpr int kWindowsPerStep = 10;  // lost when the clock steps
constexpr int kTwice = 2;
constexpr double kDaysPerYear = 365.25;

int judge(const SoakOptions& o, const SoakResult& r) {
  int failed = 0;
  const auto line = [&](bool holds, const std::string& text) {
    failed += holds ? 0 : 1;
    fmt::print("{} {}\n", holds ? "holds " : "FAILS ", text);
  };
  const auto growth = static_cast<double>(r.growth());
  const double allowed = kTwice * o.alarms_per_year * o.days / kDaysPerYear;
  fmt::print("{} instants, {} samples, {:.0f} times real time\n", r.instants, r.samples,
             static_cast<double>(r.instants) / 100 / r.wall_s);
  line(growth <= kMaxGrowth_bytes,
       fmt::format("resident: {:.1f} MiB, {:+.2f} MiB at most after the first fifth",
                   r.resident.empty() ? 0 : static_cast<double>(r.resident.front()) / (1 << 20),
                   growth / (1 << 20)));
  line(r.windows >= r.expected_windows - kWindowsPerStep * SoakNight::kClockSteps &&
           r.breaks <= SoakNight::kClockSteps,
       fmt::format("windows: {} of {}, {} breaks for {} steps of the clock", r.windows,
                   r.expected_windows, r.breaks, SoakNight::kClockSteps));
  line(r.sum_error <= kSumError && r.sums_compared > 0,
       fmt::format("sums: differ by {:.1e} from those of only the last half minute, {} times",
                   r.sum_error, r.sums_compared));
  line(r.history_trouble.empty() && r.raw_dropped == 0 && r.summary_dropped == 0 &&
           std::abs(r.summarised_windows - r.windows) <= 3 * SoakNight::kClockSteps &&
           r.hourly_windows == r.summarised_windows,
       fmt::format("history: {} of {} windows in the shortest periods, {} in the longest; dropped: "
                   "{} samples, {} periods; {}",
                   r.summarised_windows, r.windows, r.hourly_windows, r.raw_dropped,
                   r.summary_dropped, r.history_trouble.empty() ? "sound" : r.history_trouble));
  line(r.alarms <= allowed,
       fmt::format("false alarms: {}, allowed {:.1f} (twice the {:g} per year)", r.alarms, allowed,
                   o.alarms_per_year));
  fmt::print("long windows: {}, with values {}\n", r.long_windows, r.long_values);
  for (const std::string& told : r.told) fmt::print("event: {}\n", told);
  return failed == 0 ? 0 : 1;
}

int main(int count, char** arguments) {
  SoakOptions o;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    const bool has_value = i + 1 < count;
    if (argument == "--days" && has_value)
      o.days = std::atof(arguments[++i]);
    else if (argument == "--seed" && has_value)
      o.seed = std::strtoull(arguments[++i], nullptr, 10);
    else if (argument == "--alarms-per-year" && has_value)
      o.alarms_per_year = std::atof(arguments[++i]);
    else if (!argument.starts_with("-") && o.directory.empty())
      o.directory = std::filesystem::absolute(argument);
    else
      o.days = -1;
  }
  if (o.directory.empty() || !(o.days > 0) || !(o.alarms_per_year > 0)) {
    fmt::print(stderr, "{}", kUsage);
    return 2;
  }
  if (std::filesystem::exists(o.directory)) {
    fmt::print(stderr, "soak: {} already exists\n", o.directory);
    return 2;
  }
  o.looked = [](double days, std::int64_t resident, int alarms) {
    fmt::print("day {:.2f}: {:.2f} MiB resident, {} false alarms\n", days,
               static_cast<double>(resident) / (1 << 20), alarms);
    std::fflush(stdout);
  };
  return judge(o, run_soak(o));
}

}  // namespace
}  // namespace framewatch::soak

int main(int count, char** arguments) {
  return framewatch::soak::main(count, arguments);
}
