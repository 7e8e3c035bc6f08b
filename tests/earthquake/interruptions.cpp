// SPDX-License-Identifier: MIT
// interruptions: measures estimates after an interruption or a start in motion, and how soon they
// return.
#include <algorithm>
#include <cstdio>
#include <thread>

#include <fmt/core.h>

#include "daemon/base/workers.h"
#include "tests/earthquake/interruption_tables.h"
#include "tests/earthquake/study_options.h"

namespace framewatch::earthquake {
namespace {

constexpr const char* kUsage =
    R"(usage: interruptions [--seeds N] [--seed N] [--jobs N] [--building N] [--noise PERCENT]

Runs three buildings, with a right design and one off by 30 %, through starts of motion and
interruptions of 0.05 to 60 s in strong motion. Prints as Markdown how soon windows have values, the
errors of these values and how often their stated 95 % intervals contain the truth.
--seeds     motions of every building, design and interruption (6)
--seed      seed of the first motion (1)
--jobs      threads (one per processor)
--building  runs only this building, from 0
--noise     noise of the sensors, % of the rms of each channel's strong motion (1)
exit: 0 all requirements hold, 1 one does not, 2 usage
)";

int main(int count, char** arguments) {
  const auto options = StudyOptions::read(count, arguments,
                                          {"--seeds", "--seed", "--jobs", "--building", "--noise"});
  const int seeds = options ? static_cast<int>(options->number("--seeds", 6)) : 0;
  if (seeds < 1) {
    fmt::print(stderr, "{}", kUsage);
    return 2;
  }
  std::vector<InterruptionCase> cases =
      interruption_cases(seeds, static_cast<std::uint64_t>(options->number("--seed", 1)));
  if (options->given("--building"))
    std::erase_if(cases, [&](const InterruptionCase& c) {
      return c.building != static_cast<int>(options->number("--building", 0));
    });
  for (InterruptionCase& c : cases) c.noise_ratio = 0.01 * options->number("--noise", 1);
  std::vector<InterruptionResult> results(cases.size());
  const daemon::Workers workers(static_cast<int>(
      options->number("--jobs", std::max(1U, std::thread::hardware_concurrency()))));
  workers.run("interruptions", static_cast<int>(cases.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    results[at] = run_interruption(cases[at]);
  });
  fmt::print("{}\nMust reach:\n\n", interruption_tables(cases, results));
  bool all = true;
  for (const Demand& demand : interruption_demands(cases, results)) {
    fmt::print("- {} {}\n", demand.holds ? "holds:" : "FAILS:", demand.text);
    all = all && demand.holds;
  }
  return all ? 0 : 1;
}

}  // namespace
}  // namespace framewatch::earthquake

int main(int count, char** arguments) {
  return framewatch::earthquake::main(count, arguments);
}
