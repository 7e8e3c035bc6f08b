#include "fleet/archive/manifest_command.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/config/config.h"
#include "fleet/archive/archive_logs.h"
#include "fleet/archive/program_identity.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kManifest = "fleet manifest";

/// Names go into a file of lines and tabs.
std::string problem_of_name(const std::string& name) {
  return name.find_first_of("\t\n") == std::string::npos
             ? ""
             : name + ": a tab or a line's end in a name";
}

}  // namespace

int manifest(const ManifestArguments& a) {
  std::vector<daemon::ConfigProblem> wrong;
  const auto config = daemon::load_config(a.config, wrong);
  daemon::print_problems(wrong);
  if (!config) return daemon::kBadInput;
  std::vector<std::string> problems;
  for (const std::string& name : {a.config, a.folder})
    if (const std::string problem = problem_of_name(name); !problem.empty())
      problems.push_back(problem);
  const std::int64_t longest_s =
      config->history.value_or(daemon::HistorySettings{}).summary_s.back();
  if (a.hours * std::int64_t{3600} % longest_s != 0)
    problems.push_back(fmt::format("--hours: {} h are no multiple of the longest summary, {} s",
                                   a.hours, longest_s));
  std::vector<ArchiveLog> logs = archive_logs(a.places, *config, problems);
  if (problems.empty()) add_digests(logs, problems);
  const std::string program = program_identity();
  if (program.empty()) problems.push_back("/proc/self/exe: cannot be read");
  for (const std::string& problem : problems) daemon::refuse(kManifest, problem);
  if (!problems.empty()) return daemon::kBadInput;

  const ArchivePlan plan{a.config, a.folder, a.hours * std::int64_t{3600},
                         std::llround(a.warm_up_s), making_of(program, config->sha256)};
  std::string text;
  for (const ArchiveTask& task : plan_tasks(plan, logs)) text += manifest_line(task);
  if (text.empty()) return daemon::refuse(kManifest, "no log holds a sample");
  std::error_code error;
  std::filesystem::create_directories(a.folder, error);
  if (error) return daemon::refuse(kManifest, a.folder + ": " + error.message());
  (void)std::fputs(text.c_str(), stdout);
  return 0;
}

}  // namespace framewatch::fleet
