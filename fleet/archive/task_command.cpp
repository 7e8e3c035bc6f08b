#include "fleet/archive/task_command.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/exit_code.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/process.h"
#include "daemon/base/utc_time.h"
#include "daemon/config/config.h"
#include "drivers/files/text_output.h"
#include "fleet/archive/archive_task.h"
#include "fleet/archive/parameter_means.h"
#include "fleet/archive/program_identity.h"
#include "fleet/archive/reidentify.h"
#include "fleet/archive/task_lock.h"

namespace framewatch::fleet {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kTask = "fleet task";

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

/// Who does it: the job of Slurm, or of GNU parallel.
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

/// Done already: the line that was written then is there, and so is what it is about.
bool is_done(const ArchiveTask& task) {
  std::string error;
  const auto text = daemon::read_text_file(task.out + ".json", error);
  if (!text || ::access((task.out + ".sqlite").c_str(), R_OK) != 0) return false;
  const Json line = Json::parse(*text, nullptr, false);
  return line.is_object() && line.value("key", Json()) == task.key &&
         line.value("result", Json()) == "done";
}

/// Does the tasks of one manifest, whose configurations are read once.
class Tasks {
 public:
  Tasks() : program_(program_identity()) {}

  /// False when it failed.
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
    // Last, and whole: it says that the task is done.
    const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    const std::string problem = drivers::write_text_file(task.out + ".json", text);
    if (!problem.empty()) return fail(task, problem);
    (void)std::fputs(text.c_str(), stdout);
    (void)std::fflush(stdout);
    return true;
  }

 private:
  /// Reads the configuration, and compares what the manifest was made with.
  std::string problem_before(const ArchiveTask& task) {
    if (!config_ || config_->path != task.config) {
      std::vector<daemon::ConfigProblem> wrong;
      config_ = daemon::load_config(task.config, wrong);
      daemon::print_problems(wrong);
      if (!config_) return task.config + ": cannot be used";
    }
    if (!task.key.starts_with(making_of(program_, config_->sha256) + "-"))
      return "program or configuration are not those of the manifest: make a new one";
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
