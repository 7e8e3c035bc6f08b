// SPDX-License-Identifier: MIT
#include "daemon/tools/lab/reproduce_command.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <fmt/core.h>
#include <fmt/format.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/progress.h"
#include "daemon/tools/lab/reproduction.h"
#include "daemon/tools/lab/reproduction_report.h"
#include "drivers/files/text_output.h"

namespace framewatch::daemon {
namespace {

constexpr int kBroken = 1;

std::string data_folder() {
  const char* set = std::getenv("FRAMEWATCH_DATA");
  return set != nullptr ? set : "";
}

/// Tells the user which data are missing and what replaces them.
void print_missing_data(const Reproduction& all) {
  if (all.motions_missing)
    fmt::print(stderr,
               "reproduce: the paper's ground motions are not in FRAMEWATCH_DATA{}; seeded "
               "Kanai-Tajimi motions replace them\n",
               data_folder().empty() ? " (not set)" : " (" + data_folder() + ")");
  if (all.measured_table_missing)
    fmt::print(stderr,
               "reproduce: the measured shaking table is not in FRAMEWATCH_DATA; only the virtual "
               "one is evaluated\n");
}

Reproduction measured(const ReproduceArguments& a) {
  ProgressLine progress("reproduce", a.quiet);
  std::string part;
  const Workers workers(
      a.threads > 0 ? a.threads : static_cast<int>(std::thread::hardware_concurrency()),
      [&](const std::string& what, int done, int count) {
        if (what != part) progress.part_begins();
        part = what;
        progress(fmt::format("{}: run {} of {}", what, done, count),
                 static_cast<double>(done) / count);
      });
  return reproduce_paper(a.only, a.seeds, data_folder(), workers);
}

}  // namespace

int reproduce(const ReproduceArguments& a) {
  const auto& cases = reproduction_cases();
  if (!a.only.empty() && std::find(cases.begin(), cases.end(), a.only) == cases.end())
    return refuse("reproduce", fmt::format("--case {}: unknown case; choose one of {}", a.only,
                                           fmt::join(cases, ", ")));
  std::error_code error;
  std::filesystem::create_directories(a.out, error);
  if (error) return refuse("reproduce", fmt::format("{}: {}", a.out, error.message()));
  const Reproduction all = measured(a);
  if (!a.quiet) print_missing_data(all);
  const bool tables = a.only.empty() || !all.few_sensors.empty();
  std::string why =
      drivers::write_text_file(a.out + "/report.html", reproduction_html(all, a.only));
  if (why.empty() && tables)
    why = drivers::write_text_file(a.out + "/accuracy.md", accuracy_markdown(all));
  if (!why.empty()) return refuse("reproduce", why);

  const std::vector<Promise> list = promises(all);
  const auto broken =
      std::count_if(list.begin(), list.end(), [](const Promise& p) { return !p.kept; });
  for (const Promise& promise : list)
    if (!promise.kept) fmt::print("not kept: {}: {}\n", promise.what, promise.measured);
  if (!a.quiet)
    fmt::print(
        "{}/report.html{}; {}\n", a.out, tables ? fmt::format(", {}/accuracy.md", a.out) : "",
        list.empty() ? fmt::format("fewer than {} seeds: no promise judged", kSeedsToJudge)
                     : fmt::format("{} of {} promises kept",
                                   static_cast<std::ptrdiff_t>(list.size()) - broken, list.size()));
  return broken > 0 ? kBroken : 0;
}

}  // namespace framewatch::daemon
