// SPDX-License-Identifier: MIT
// changes: measures when changes of stiffness are announced and how right their sizes are.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <thread>

#include <fmt/core.h>

#include "daemon/base/workers.h"
#include "tests/earthquake/change_tables.h"
#include "tests/earthquake/study_options.h"

namespace framewatch::earthquake {
namespace {

constexpr const char* kUsage =
    R"(usage: changes [--cases N] [--seed N] [--jobs N] [--hop S] [--most-delay S] [--only NUMBER]

Runs the daemon's estimation with [watch] on simulated earthquakes in which one or two elements lose
5 to 40 % of their stiffness, on a fifth as many without a change, and on a tenth as many in which
every element loses 5 %. Prints the announcements, their times and the errors of their sizes as
Markdown.
--cases       cases with a loss (500)
--seed        seed of all cases (1)
--jobs        threads (one per processor)
--hop         seconds between windows (0.01)
--most-delay  largest median time to the first announcement, s (none)
--only        runs only this case (from 0; controls follow the losses) and prints its announcements
exit: 0 all requirements hold, 1 one does not, 2 usage
)";

struct Numbered {
  ChangeKind kind;
  int number;
};

std::vector<Numbered> numbered(int losses) {
  constexpr int kPerControl = 5, kPerUniform = 10;
  std::vector<Numbered> out;
  for (int i = 0; i < losses; ++i) out.push_back({ChangeKind::loss, i});
  for (int i = 0; i < losses / kPerControl; ++i) out.push_back({ChangeKind::none, i});
  for (int i = 0; i < losses / kPerUniform; ++i) out.push_back({ChangeKind::uniform, i});
  return out;
}

void print_case(const ChangeCase& of, const ChangeRun& run) {
  constexpr const char* kStates[] = {"cleared", "raised", "changed"};
  fmt::print("{}\n", of.text());
  for (const std::string& name : run.without_baseline) fmt::print("without a baseline: {}\n", name);
  for (const Announcement& a : run.said) {
    const bool named = a.parameter >= 0;
    fmt::print("{:8.2f} s  {:>3} {:8} {:14} ", a.at_s, a.id, kStates[static_cast<int>(a.state)],
               named ? run.names[static_cast<std::size_t>(a.parameter)] : "(building)");
    if (a.sized) fmt::print("{:+.2f} +- {:.2f} %", 100 * a.ratio, 100 * a.std_error);
    if (named)
      fmt::print("  truth {:+.2f} %",
                 100 * of.truth(a.at_s)[static_cast<std::size_t>(a.parameter)]);
    fmt::print("\n");
  }
}

int main(int count, char** arguments) {
  const auto options = StudyOptions::read(
      count, arguments, {"--cases", "--seed", "--jobs", "--hop", "--most-delay", "--only"});
  const int losses = options ? static_cast<int>(options->number("--cases", 500)) : 0;
  if (losses < 1) {
    fmt::print(stderr, "{}", kUsage);
    return 2;
  }
  const auto seed = static_cast<std::uint64_t>(options->number("--seed", 1));
  ChangeRunOptions run;
  run.hop_s = options->number("--hop", run.hop_s);
  const std::vector<Numbered> all = numbered(losses);
  if (options->given("--only")) {
    const auto at = static_cast<std::size_t>(options->number("--only", 0));
    if (at >= all.size()) {
      fmt::print(stderr, "changes: --only: there are cases 0 to {}\n", all.size() - 1);
      return 2;
    }
    const ChangeCase of = change_case(all[at].kind, seed, all[at].number);
    print_case(of, run_change(of, run));
    return 0;
  }
  std::vector<ScoredCase> cases(all.size());
  const daemon::Workers workers(static_cast<int>(
      options->number("--jobs", std::max(1U, std::thread::hardware_concurrency()))));
  workers.run("changes", static_cast<int>(all.size()), [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    ChangeCase of = change_case(all[at].kind, seed, all[at].number);
    const CaseScore score = score_change(of, run_change(of, run));
    cases[at] = {std::move(of), score};
  });
  fmt::print("{}\nMust reach:\n\n", change_tables(cases));
  bool good = true;
  const double most_delay_s =
      options->number("--most-delay", std::numeric_limits<double>::infinity());
  for (const Demand& demand : change_demands(cases, most_delay_s)) {
    fmt::print("- {} {}\n", demand.holds ? "holds:" : "FAILS:", demand.text);
    good = good && demand.holds;
  }
  return good ? 0 : 1;
}

}  // namespace
}  // namespace framewatch::earthquake

int main(int count, char** arguments) {
  return framewatch::earthquake::main(count, arguments);
}
