// SPDX-License-Identifier: MIT
#include "daemon/tools/compare/compare_command.h"

#include <filesystem>
#include <set>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/printable.h"
#include "drivers/files/standard_streams.h"
#include "drivers/files/text_output.h"

namespace framewatch::daemon {
namespace {

/// Returns true if the output is one of the sources.
bool is_source(const std::string& out, const std::vector<std::string>& sources) {
  for (const std::string& source : sources) {
    std::error_code error;
    if (out == source || std::filesystem::equivalent(out, source, error)) return true;
  }
  return false;
}

std::vector<ComparedRun> read_runs(const CompareArguments& a, std::vector<std::string>& problems) {
  std::vector<ComparedRun> runs;
  std::set<std::string> names;
  bool unique = true;
  for (const std::string& source : a.sources) {
    auto run = read_run(source, a.options, problems);
    if (!run) continue;
    unique = names.insert(run->name).second && unique;
    if (const std::string digest = sha256_of_file(source); !digest.empty())
      run->report.files.push_back({run->what, source, digest});
    runs.push_back(*std::move(run));
  }
  for (std::size_t i = 0; i < runs.size() && !unique && runs.size() == a.sources.size(); ++i)
    runs[i].name = a.sources[i];
  return runs;
}

}  // namespace

int compare(const CompareArguments& a) {
  if (a.sources.size() < 2) return refuse("compare", "needs at least two sources");
  if (const std::string problem = problem_of_page_name(a.out); !problem.empty())
    return refuse("compare", problem + ". --figures writes the pictures as files");
  if (!a.out.empty() && is_source(a.out, a.sources))
    return refuse("compare", a.out + ": is input and output; name another output");
  std::vector<std::string> problems;
  ReportAbout about;
  if (!a.about.empty()) {
    std::vector<ConfigProblem> found;
    about = read_about(a.about, found).value_or(ReportAbout{});
    for (const ConfigProblem& p : found) problems.push_back(p.where + ": " + p.message);
  }
  std::vector<ComparedRun> runs = read_runs(a, problems);
  for (std::size_t r = 1; r < runs.size() && problems.empty(); ++r)
    if (const std::string why = why_unlike(runs.front(), runs[r]); !why.empty())
      problems.push_back(fmt::format("{} (first) and {} (second) are unlike buildings: {}",
                                     runs.front().name, runs[r].name, why));
  for (const std::string& problem : problems)
    fmt::print(stderr, "framewatch compare: {}\n", printable_lines(problem));
  if (!problems.empty()) return kBadInput;
  Comparison comparison = compare_runs(std::move(runs), a.limits);
  comparison.about = std::move(about);
  std::string problem;
  if (!a.figures.folder.empty())
    problem = write_pictures(comparison_pictures(comparison), a.figures);
  if (problem.empty() && !a.out.empty())
    problem = drivers::write_text_file(a.out, comparison_html(comparison));
  if (!problem.empty()) return refuse("compare", problem);
  if (a.json)
    fmt::print("{}", comparison_json(comparison));
  else if (!a.quiet && a.out != drivers::kStandardOutput)
    fmt::print("{}", printable_lines(comparison_text(comparison)));
  return comparison.different() || !comparison.judged() ? kFailed : 0;
}

}  // namespace framewatch::daemon
