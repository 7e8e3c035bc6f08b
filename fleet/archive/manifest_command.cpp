// SPDX-License-Identifier: MIT
#include "fleet/archive/manifest_command.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <set>
#include <system_error>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/utc_time.h"
#include "daemon/base/workers.h"
#include "daemon/config/config.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/raw_history_reader.h"
#include "daemon/tools/replay/replay_survey.h"
#include "fleet/archive/archive_task.h"

namespace framewatch::fleet {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kLongestRawLog_us = 86'400'000'000;  // a raw log covers at most a day
constexpr std::size_t kMaxTasks = 100'000;
constexpr std::int64_t kFollows_us = 2 * 3'600'000'000;  // longer logs are read for their end
constexpr std::int64_t kMargin_us = 10'000'000;  // after the end, for late windows and nodes

/// Returns the absolute path, which a task can open from any folder.
std::string absolute(const std::string& path) {
  std::error_code error;
  const fs::path whole = fs::absolute(path, error);
  return error ? path : whole.lexically_normal().string();
}

/// Returns the start of a raw log from its name; nullopt for other files.
std::optional<std::int64_t> raw_start_us(const std::string& path) {
  const std::string name = fs::path(path).filename().string();
  const bool raw = name.ends_with(".lcmlog") || name.ends_with(".lcmlog.zst");
  return raw ? daemon::read_utc_stamp(name) : std::nullopt;
}

/// Reads the times of the samples in a log. Returns the problems.
std::vector<std::string> read_times(const daemon::Config& config, ArchiveLog& log) {
  daemon::ReplaySurvey survey(config, true);
  survey.add(log.path);
  if (!survey.problems().empty() || !survey.any_sample()) return survey.problems();
  log.start_us = survey.first_us();
  log.end_us = log.start_us + std::llround(survey.measured_seconds() * 1e6) + 1;
  return {};
}

void add_folder(const std::string& folder, std::vector<ArchiveLog>& out,
                std::vector<std::string>& problems) {
  std::error_code none;
  const std::string raw = daemon::raw_folder(folder);
  const auto found = fs::is_directory(raw, none)
                         ? daemon::raw_logs_between(folder, INT64_MIN / 4, INT64_MAX / 4)
                         : daemon::raw_logs(folder);
  std::size_t taken = 0;
  for (const daemon::RawLog& log : found) {
    if (log.partial) continue;
    out.push_back({absolute(log.path), log.start_us, log.start_us + kLongestRawLog_us});
    ++taken;
  }
  if (taken == 0) problems.push_back(folder + ": has no closed raw log");
}

void add_file(const std::string& path, const daemon::Config& config, std::vector<ArchiveLog>& out,
              std::vector<std::string>& problems) {
  std::error_code error;
  if (const auto start_us = raw_start_us(path); start_us && fs::is_regular_file(path, error)) {
    out.push_back({absolute(path), *start_us, *start_us + kLongestRawLog_us});
    return;
  }
  ArchiveLog log{absolute(path)};
  const std::vector<std::string> found = read_times(config, log);
  problems.insert(problems.end(), found.begin(), found.end());
  if (found.empty() && log.end_us > log.start_us) out.push_back(log);
}

std::int64_t floor_to(std::int64_t time_us, std::int64_t step_us) {
  const std::int64_t rest = time_us % step_us;
  return time_us - (rest < 0 ? rest + step_us : rest);
}

constexpr const char* kManifest = "fleet manifest";

/// Rejects names that a file of lines and tabs cannot hold.
std::string problem_of_name(const std::string& name) {
  return name.find_first_of("\t\n") == std::string::npos
             ? ""
             : name + ": a name must not have a tab or line break";
}

}  // namespace

std::vector<ArchiveLog> archive_logs(const std::vector<std::string>& places,
                                     const daemon::Config& config,
                                     std::vector<std::string>& problems) {
  std::vector<ArchiveLog> out;
  for (const std::string& place : places) {
    std::error_code none;
    if (fs::is_directory(place, none))
      add_folder(place, out, problems);
    else
      add_file(place, config, out, problems);
  }
  std::stable_sort(out.begin(), out.end(), [](const ArchiveLog& a, const ArchiveLog& b) {
    return a.start_us < b.start_us;
  });
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i].path.find_first_of("\t\n") != std::string::npos)
      problems.push_back(out[i].path + ": a name must not have a tab or line break");
    if (i == 0) continue;
    if (out[i].path == out[i - 1].path) problems.push_back(out[i].path + ": is given twice");
    out[i - 1].end_us = std::min(out[i - 1].end_us, out[i].start_us + daemon::kSecond_us);
  }
  // A damaged log keeps its day; its task reports the damage.
  for (ArchiveLog& log : out)
    if (log.end_us - log.start_us > kFollows_us && raw_start_us(log.path))
      (void)read_times(config, log);
  return out;
}

void add_digests(std::vector<ArchiveLog>& logs, std::vector<std::string>& problems) {
  const daemon::Workers workers(
      static_cast<int>(std::max(1U, std::thread::hardware_concurrency())));
  workers.run("reading", static_cast<int>(logs.size()), [&](int i) {
    ArchiveLog& log = logs[static_cast<std::size_t>(i)];
    log.sha256 = daemon::sha256_of_file(log.path);
  });
  for (const ArchiveLog& log : logs)
    if (log.sha256.empty()) problems.push_back(log.path + ": cannot be read");
}

std::vector<ArchiveTask> plan_tasks(const ArchivePlan& plan, const std::vector<ArchiveLog>& logs) {
  std::vector<ArchiveTask> out;
  const std::int64_t length_us = plan.length_s * daemon::kSecond_us;
  std::set<std::int64_t> starts;
  for (const ArchiveLog& log : logs)
    for (std::int64_t from_us = floor_to(log.start_us, length_us);
         from_us < log.end_us && starts.size() < kMaxTasks; from_us += length_us)
      starts.insert(from_us);
  for (const std::int64_t from_us : starts) {
    ArchiveTask task;
    task.config = absolute(plan.config);
    task.from_us = from_us;
    task.to_us = from_us + length_us;
    task.warm_up_us = from_us - plan.warm_up_s * daemon::kSecond_us;
    std::vector<std::string> digests;
    for (const ArchiveLog& log : logs) {
      if (log.start_us >= task.to_us + kMargin_us || log.end_us <= task.warm_up_us) continue;
      task.logs.push_back(log.path);
      digests.push_back(log.sha256);
    }
    task.number = static_cast<int>(out.size()) + 1;
    task.out = absolute((fs::path(plan.folder) / daemon::utc_stamp(from_us)).string());
    task.key = task_key(plan.making, task, digests);
    out.push_back(std::move(task));
  }
  return out;
}

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
    problems.push_back(fmt::format("--hours: {} h must be a multiple of the longest summary, {} s",
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
  if (text.empty()) return daemon::refuse(kManifest, "no log has a sample");
  std::error_code error;
  std::filesystem::create_directories(a.folder, error);
  if (error) return daemon::refuse(kManifest, a.folder + ": " + error.message());
  (void)std::fputs(text.c_str(), stdout);
  return 0;
}

}  // namespace framewatch::fleet
