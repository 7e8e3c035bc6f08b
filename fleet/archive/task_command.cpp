// SPDX-License-Identifier: MIT
#include "fleet/archive/task_command.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <nlohmann/json_fwd.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/exit_code.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/process.h"
#include "daemon/base/sqlite_file.h"
#include "daemon/base/utc_time.h"
#include "daemon/config/config.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/history/history_schema.h"
#include "daemon/tools/replay/first_passes.h"
#include "daemon/tools/replay/history_output.h"
#include "daemon/tools/replay/replay_survey.h"
#include "drivers/files/text_output.h"
#include "fleet/archive/archive_task.h"

namespace framewatch::fleet {
namespace {

/// The result of a task.
struct Reidentified {
  std::string problem;             ///< why there is no output; else empty
  std::vector<std::string> notes;  ///< damage and other remarks
  int passes = 1;                  ///< over the logs: first to tune, last to estimate
  std::int64_t windows = 0;        ///< published, including the warm-up
  std::int64_t instants = 0;       ///< on the common grid
  std::int64_t damaged_bytes = 0;
  double measured_s = 0;  ///< sensor time that was read
};

constexpr double kAfter_s = 10;  // until the last window of the task is published
constexpr std::size_t kMaxNotes = 20;

daemon::ReplaySpan span_of(const ArchiveTask& task) {
  const auto length_us = static_cast<double>(task.to_us - task.warm_up_us);
  return {0, length_us * 1e-6 + kAfter_s, task.warm_up_us};
}

/// Runs the logs of a task through an estimation and writes the task's time to `path`, a database
/// with the tables of a history. Uses the intact parts of damaged logs.
Reidentified reidentify(const daemon::Config& config, const ArchiveTask& task,
                        const std::string& path) {
  Reidentified out;
  daemon::HistoryOutput history(config);
  const std::int64_t longest_us = history.longest_s() * daemon::kSecond_us;
  if (task.from_us % longest_us != 0 || task.to_us % longest_us != 0) {
    out.problem = fmt::format("start and end must be multiples of the longest summary, {} s",
                              history.longest_s());
    return out;
  }
  history.keep(task.from_us, task.to_us);
  if (!history.open(path)) {
    out.problem = path + ": " + history.error();
    return out;
  }
  bool taken = true;
  daemon::Estimation estimation(config, [&](std::int64_t time_us, const std::string& channel,
                                            const std::vector<std::uint8_t>& bytes) {
    taken = taken && history.put(time_us, channel, bytes);
  });
  const daemon::FirstPasses first(config, {task.logs, {}, true, span_of(task)});
  if (first.tuning()) estimation.start_tuned(*first.tuning());
  out.passes = first.passes() + 1;
  fmt::print(stderr, "task {}: {}\n", task.number, first.note());
  daemon::ReplaySurvey survey(config, true, span_of(task));
  survey.feed(estimation);
  for (const std::string& log : task.logs)
    if (survey.problems().empty() && taken) survey.add(log);
  estimation.finish();
  out.notes = survey.notes();
  if (out.notes.size() > kMaxNotes) {
    out.notes.resize(kMaxNotes);
    out.notes.push_back("further notes are left out");
  }
  out.windows = estimation.windows();
  out.instants = estimation.pipeline().counters().sample_sets;
  out.damaged_bytes = survey.damaged_bytes();
  out.measured_s = survey.any_sample() ? survey.measured_seconds() : 0;
  if (!survey.problems().empty())
    out.problem = survey.problems().front();
  else if (!history.close())
    out.problem = path + ": " + history.error();
  return out;
}

constexpr const char* kMeans =
    "SELECT name, unit, sum(observable), sum(observable * mean) / sum(observable),"
    " sqrt(sum(observable * std_error * std_error) / sum(observable)), min(min), max(max)"
    " FROM summary JOIN parameter ON parameter.id = parameter"
    " WHERE period_s = (SELECT min(period_s) FROM period) GROUP BY parameter ORDER BY parameter";

/// Summarizes each parameter of a database with the tables of a history over its shortest periods.
/// Returns an object by name with the unit, the number of windows with a value, the mean, the least
/// and the largest value. std_error is the root mean square of the windows' errors. Returns null if
/// the database cannot be read.
nlohmann::ordered_json parameter_means(const std::string& database) {
  daemon::SqliteFile file;
  if (!file.open_to_read(database) ||
      !daemon::version_problem(file, daemon::history_schema()).empty())
    return nullptr;
  daemon::SqliteStatement all = file.prepare(kMeans);
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  while (all.row())
    out[all.text(0)] = {{"unit", all.text(1)},   {"observable", all.integer(2)},
                        {"mean", all.number(3)}, {"std_error", all.number(4)},
                        {"min", all.number(5)},  {"max", all.number(6)}};
  return file.failed() ? nlohmann::ordered_json() : out;
}

using Json = nlohmann::ordered_json;

constexpr const char* kTask = "fleet task";

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

/// Returns the id of the Slurm or GNU parallel job that runs this program; empty without one.
std::string worker_name() {
  for (const char* variable : {"SLURM_ARRAY_JOB_ID", "SLURM_JOB_ID", "PARALLEL_SEQ"})
    if (const char* value = std::getenv(variable); value != nullptr) return value;
  return {};
}

Json line_of(const ArchiveTask& task, const std::string& result) {
  return {{"schema", "framewatch.reid/1"},
          {"task", task.number},
          {"key", task.key},
          {"result", result},
          {"from", daemon::utc_text(task.from_us)},
          {"to", daemon::utc_text(task.to_us)},
          {"out", task.out + ".sqlite"},
          {"host", host_name()},
          {"worker", worker_name()}};
}

/// Returns true if the output of the task exists with the JSON line that says so.
bool is_done(const ArchiveTask& task) {
  std::string error;
  const auto text = daemon::read_text_file(task.out + ".json", error);
  if (!text || ::access((task.out + ".sqlite").c_str(), R_OK) != 0) return false;
  const Json line = Json::parse(*text, nullptr, false);
  return line.is_object() && line.value("key", Json()) == task.key &&
         line.value("result", Json()) == "done";
}

/// Runs the tasks of one manifest. Reads their configuration once.
class Tasks {
 public:
  Tasks() : program_(program_identity()) {}

  /// Runs one task. Returns false if it failed.
  bool run(const ArchiveTask& task) {
    TaskLock lock;
    if (const std::string problem = lock.take(task.out + ".lock"); !problem.empty())
      return fail(task, task.out + ".lock: " + problem);
    if (is_done(task)) return say(line_of(task, "done_before"));
    const auto began = std::chrono::steady_clock::now();
    const double cpu_s = daemon::process_usage().cpu_s;
    if (const std::string problem = problem_before(task); !problem.empty())
      return fail(task, problem);
    const Reidentified made = reidentify(*config_, task, task.out + ".sqlite");
    if (!made.problem.empty()) return fail(task, made.problem);
    Json line = line_of(task, "done");
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - began;
    line["seconds"] = seconds.count();
    line["cpu_s"] = daemon::process_usage().cpu_s - cpu_s;
    line["logs"] = task.logs.size();
    line["measured_s"] = made.measured_s;
    line["passes"] = made.passes;
    line["instants"] = made.instants;
    line["windows"] = made.windows;
    line["damaged_bytes"] = made.damaged_bytes;
    line["notes"] = made.notes;
    line["parameters"] = parameter_means(task.out + ".sqlite");
    // Written last and atomically, because this file marks the task as done.
    const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    const std::string problem = drivers::write_text_file(task.out + ".json", text);
    if (!problem.empty()) return fail(task, problem);
    (void)std::fputs(text.c_str(), stdout);
    (void)std::fflush(stdout);
    return true;
  }

 private:
  /// Reads the configuration and checks that the manifest was made with it and this program.
  std::string problem_before(const ArchiveTask& task) {
    if (!config_ || config_->path != task.config) {
      std::vector<daemon::ConfigProblem> wrong;
      config_ = daemon::load_config(task.config, wrong);
      daemon::print_problems(wrong);
      if (!config_) return task.config + ": cannot be used";
    }
    if (!task.key.starts_with(making_of(program_, config_->sha256) + "-"))
      return "the program or configuration has changed since the manifest: make a new one with "
             "framewatch fleet manifest";
    return {};
  }

  bool fail(const ArchiveTask& task, const std::string& problem) {
    daemon::refuse(kTask, fmt::format("task {}: {}", task.number, problem));
    Json line = line_of(task, "failed");
    line["problem"] = problem;
    say(line);
    return false;
  }

  static bool say(const Json& line) {
    (void)std::fputs((line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n").c_str(),
                     stdout);
    (void)std::fflush(stdout);
    return true;
  }

  std::string program_;
  std::optional<daemon::Config> config_;
};

}  // namespace

int task(const TaskArguments& a) {
  std::string problem;
  const auto all = read_manifest(a.manifest, problem);
  if (!all) return daemon::refuse(kTask, problem);
  const auto count = static_cast<int>(all->size());
  for (const int number : a.numbers)
    if (number < 1 || number > count)
      return daemon::refuse(
          kTask, fmt::format("{}: has the tasks 1 to {}, not {}", a.manifest, count, number));
  Tasks tasks;
  bool good = true;
  for (const int number : a.numbers)
    good = tasks.run((*all)[static_cast<std::size_t>(number - 1)]) && good;
  return good ? 0 : daemon::kFailed;
}

}  // namespace framewatch::fleet
