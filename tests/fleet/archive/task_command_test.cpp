// SPDX-License-Identifier: MIT
#include "fleet/archive/task_command.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/sqlite_file.h"
#include "daemon/config/config.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/tools/replay/history_output.h"
#include "daemon/tools/replay/replay_survey.h"
#include "fleet/archive/archive_task.h"
#include "fleet/archive/manifest_command.h"
#include "tests/support/child.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/shell.h"
#include "tests/support/temporary.h"

namespace framewatch::fleet {
namespace task_command_test {

namespace fs = std::filesystem;
using daemon::kSecond_us;
using Json = nlohmann::json;

// Limits.
constexpr int kKills = 12;

constexpr double kRecorded_s = 24;
constexpr std::int64_t kTask_s = 8;

/// Rows of the finished periods and their summaries.
std::vector<std::string> rows_of(const std::string& database, std::int64_t from_us,
                                 std::int64_t to_us) {
  daemon::SqliteFile file;
  EXPECT_TRUE(file.open_to_read(database)) << database;
  daemon::SqliteStatement all = file.prepare(
      "SELECT period_s, start_us, windows, name, observable, mean, std_error, q1, median, q3,"
      " outliers, boxed FROM summary JOIN parameter ON parameter.id = parameter"
      " JOIN period USING (period_s, start_us) WHERE start_us >= ? AND start_us < ?"
      " ORDER BY 1, 2, parameter");
  all.bind(1, from_us).bind(2, to_us);
  std::vector<std::string> out;
  while (all.row()) {
    out.emplace_back();
    for (int column = 0; column < 12; ++column) out.back() += all.text(column) + " ";
  }
  EXPECT_FALSE(file.failed());
  return out;
}

/// An archive of one log that ends within its third task, and its manifest.
class FleetTask : public testing::Test {
 protected:
  FleetTask() {
    test::record_table_test(log_, kRecorded_s);
    plan(test::read_file(test::table_config()));
  }

  void plan(const std::string& building) {
    test::write_file(config_, building + "\n[history]\ndirectory = \"h\"\nsummary_s = [1, 2, 4]\n");
    std::vector<std::string> problems;
    std::vector<daemon::ConfigProblem> wrong;
    const auto config = daemon::load_config(config_, wrong);
    std::vector<ArchiveLog> logs = archive_logs({log_}, *config, problems);
    add_digests(logs, problems);
    EXPECT_TRUE(problems.empty());
    fs::create_directories(directory_.path("out"));
    tasks_ = plan_tasks({config_, directory_.path("out"), kTask_s, 3600,
                         making_of(program_identity(), config->sha256)},
                        logs);
    write_manifest();
  }

  void write_manifest() const {
    std::string text;
    for (const ArchiveTask& task : tasks_) text += manifest_line(task);
    test::write_file(manifest_, text);
  }

  /// Returns the exit status and the printed lines.
  std::pair<int, std::vector<Json>> run(const std::vector<int>& numbers) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int status = task({manifest_, numbers});
    said_ = testing::internal::GetCapturedStderr();
    std::istringstream lines(testing::internal::GetCapturedStdout());
    std::vector<Json> out;
    for (std::string line; std::getline(lines, line);) out.push_back(Json::parse(line));
    return {status, out};
  }
  std::string output(int number) const {
    return tasks_.at(static_cast<std::size_t>(number - 1)).out + ".sqlite";
  }

  test::TemporaryDirectory directory_;
  const std::string config_ = directory_.path("building.toml"),
                    log_ = directory_.path("rec.lcmlog"), manifest_ = directory_.path("m.tsv");
  std::vector<ArchiveTask> tasks_;
  std::string said_;
};

/// Keeps the filters at the design; otherwise every task is tuned to its logs.
TEST_F(FleetTask, AllTasksGiveTheWholeReplay) {
  std::string building = test::read_file(test::table_config());
  const std::string section = "[estimator]\n";
  building.insert(building.find(section) + section.size(), "self_tune = false\n");
  plan(building);
  std::vector<daemon::ConfigProblem> wrong;
  const auto config = daemon::load_config(config_, wrong);
  daemon::HistoryOutput whole(*config);
  ASSERT_TRUE(whole.open(directory_.path("whole.sqlite")));
  {
    daemon::Estimation estimation(*config, [&](auto time_us, const auto& channel, const auto& b) {
      EXPECT_TRUE(whole.put(time_us, channel, b));
    });
    daemon::ReplaySurvey survey(*config, false);
    survey.feed(estimation);
    survey.add(log_);
    estimation.finish();
  }
  ASSERT_TRUE(whole.close());
  ASSERT_GE(tasks_.size(), 3u);
  std::vector<int> numbers;
  for (const ArchiveTask& task : tasks_) numbers.push_back(task.number);
  const auto [status, lines] = run(numbers);
  EXPECT_EQ(status, 0) << said_;
  ASSERT_EQ(lines.size(), tasks_.size());
  std::size_t rows = 0;
  for (const ArchiveTask& task : tasks_) {
    const auto part = rows_of(output(task.number), INT64_MIN / 2, INT64_MAX / 2);
    EXPECT_EQ(part, rows_of(directory_.path("whole.sqlite"), task.from_us, task.to_us));
    rows += part.size();
  }
  EXPECT_EQ(rows, rows_of(directory_.path("whole.sqlite"), INT64_MIN / 2, INT64_MAX / 2).size());
  EXPECT_GT(rows, 500u);
  EXPECT_EQ(lines[1]["schema"], "framewatch.reid/1");
  EXPECT_EQ(lines[1]["result"], "done");
  EXPECT_EQ(lines[1]["key"], tasks_[1].key);
  EXPECT_GT(lines[1]["parameters"]["kx_1_y1"]["observable"], 100);
  EXPECT_EQ(lines[1]["parameters"]["kx_1_y1"]["unit"], "N/m");
}

TEST_F(FleetTask, IsTunedToItsLogsFirst) {
  const auto [status, lines] = run({1});
  ASSERT_EQ(status, 0) << said_;
  EXPECT_GE(lines.at(0)["passes"], 2);
  EXPECT_NE(said_.find("task 1: tuned on the record first: "), std::string::npos) << said_;
}

TEST_F(FleetTask, SkipsFinishedTasks) {
  ASSERT_EQ(run({1}).first, 0) << said_;
  const std::string first = test::read_file(output(1));
  const auto written = fs::last_write_time(output(1));
  const auto [status, lines] = run({1});
  EXPECT_EQ(status, 0);
  EXPECT_EQ(lines.at(0)["result"], "done_before");
  EXPECT_EQ(fs::last_write_time(output(1)), written);
  // The line does not count without the output.
  fs::remove(output(1));
  EXPECT_EQ(run({1}).second.at(0)["result"], "done");
  EXPECT_EQ(test::read_file(output(1)), first);
  // Nor with another key, or if damaged.
  for (const std::string& line : {std::string("{\"key\": \"x\", \"result\": \"done\"}"),
                                  std::string("{\"key\": \""), std::string("[]")}) {
    test::write_file(tasks_[0].out + ".json", line);
    EXPECT_EQ(run({1}).second.at(0)["result"], "done") << line;
  }
}

TEST_F(FleetTask, AnotherConfigurationNeedsAnotherManifest) {
  test::write_file(config_, test::read_file(config_) + "\n# changed\n");
  const auto [status, lines] = run({2});
  EXPECT_EQ(status, 1);
  EXPECT_EQ(lines.at(0)["result"], "failed");
  EXPECT_NE(said_.find("task 2: the program or configuration"), std::string::npos) << said_;
  EXPECT_TRUE(fs::is_empty(directory_.path("out")));
}

TEST_F(FleetTask, AFailedTaskLeavesNoFileAndStopsNoOther) {
  tasks_[0].logs = {directory_.path("none.lcmlog")};
  write_manifest();
  const auto [status, lines] = run({1, 2});
  EXPECT_EQ(status, 1);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0]["result"], "failed");
  EXPECT_NE(lines[0]["problem"].get<std::string>().find("none.lcmlog"), std::string::npos);
  EXPECT_EQ(lines[1]["result"], "done");
  EXPECT_FALSE(fs::exists(output(1)));
  for (const auto& entry : fs::directory_iterator(directory_.path("out")))
    EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos);
}

TEST_F(FleetTask, UsesTheIntactPartOfADamagedLog) {
  std::string bytes = test::read_file(log_);
  bytes.replace(bytes.size() / 3, 100, std::string(100, '\x55'));
  test::write_file(log_, bytes);
  const auto [status, lines] = run({1});
  EXPECT_EQ(status, 0) << said_;
  EXPECT_GT(lines.at(0)["damaged_bytes"], 0);
  EXPECT_FALSE(lines[0]["notes"].empty());
}

TEST_F(FleetTask, ATimeWithoutSamplesGivesAnEmptyOutput) {
  tasks_[0].from_us += 800 * kSecond_us;
  tasks_[0].to_us += 800 * kSecond_us;
  tasks_[0].warm_up_us = tasks_[0].from_us;
  write_manifest();
  const auto [status, lines] = run({1});
  EXPECT_EQ(status, 0) << said_;
  EXPECT_EQ(lines.at(0)["windows"], 0);
  EXPECT_TRUE(rows_of(output(1), INT64_MIN / 2, INT64_MAX / 2).empty());
}

TEST_F(FleetTask, RefusesTimesBetweenPeriods) {
  tasks_[0].from_us += kSecond_us;
  write_manifest();
  EXPECT_EQ(run({1}).first, 1);
  EXPECT_NE(said_.find("multiples of the longest summary, 4 s"), std::string::npos) << said_;
}

TEST_F(FleetTask, RefusesNumbersBeyondTheManifest) {
  EXPECT_EQ(run({1, 99}).first, 2);
  EXPECT_NE(said_.find("has the tasks 1 to"), std::string::npos) << said_;
  EXPECT_TRUE(fs::is_empty(directory_.path("out")));
  test::write_file(manifest_, "nonsense\n");
  EXPECT_EQ(run({1}).first, 2);
  EXPECT_NE(said_.find("m.tsv:1: "), std::string::npos) << said_;
}

/// Runs the program, kills it at any time, and starts it again.
TEST_F(FleetTask, GivesTheSameOutputAfterBeingKilled) {
  fs::create_directories(directory_.path("raw"));
  fs::copy_file(log_, directory_.path("raw/rec.lcmlog"));
  const std::string manifest = "$F fleet manifest building.toml OUT raw/rec.lcmlog --hours 1";
  const auto made = [&](const std::string& folder) {
    std::string line = manifest;
    line.replace(line.find("OUT"), 3, folder);
    const test::ShellResult said = test::shell(directory_, line + " > " + folder + ".tsv");
    EXPECT_EQ(said.status, 0) << said.err;
  };
  made("undisturbed");
  made("killed");
  ASSERT_EQ(test::shell(directory_, "$F fleet task undisturbed.tsv 1").status, 0);
  int killed = 0;
  for (int i = 0; i < kKills; ++i) {
    test::Child child({FRAMEWATCH_PROGRAM, "fleet", "task", directory_.path("killed.tsv"), "1"});
    std::this_thread::sleep_for(std::chrono::milliseconds(15 * i));
    killed += child.stop(SIGKILL) == 128 + SIGKILL;
  }
  EXPECT_GT(killed, 0);
  const test::ShellResult last = test::shell(directory_, "$F fleet task killed.tsv 1");
  EXPECT_EQ(last.status, 0) << last.err;
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(directory_.path("killed")))
    names.push_back(entry.path().filename().string());
  EXPECT_EQ(names.size(), 2u);  // no partial file
  for (const std::string& name : names) {
    if (!name.ends_with(".sqlite")) continue;
    EXPECT_EQ(test::read_file(directory_.path("killed/" + name)),
              test::read_file(directory_.path("undisturbed/" + name)));
  }
}

TEST_F(FleetTask, ASecondWorkerWaitsAndFindsTheTaskDone) {
  std::atomic<bool> has_run = false;
  std::thread second;
  {
    TaskLock first;
    ASSERT_EQ(first.take(tasks_[0].out + ".lock"), "");
    second = std::thread([&] {
      TaskLock lock;
      EXPECT_EQ(lock.take(tasks_[0].out + ".lock"), "");
      has_run = true;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_FALSE(has_run);
  }
  second.join();
  EXPECT_TRUE(fs::is_empty(directory_.path("out")));
  TaskLock nowhere;
  EXPECT_NE(nowhere.take(directory_.path("none/x.lock")), "");
}

TEST_F(FleetTask, TheManifestCommandReportsEveryProblem) {
  const test::ShellResult said =
      test::shell(directory_, "$F fleet manifest building.toml out none.lcmlog nor.lcmlog");
  EXPECT_EQ(said.status, 2);
  EXPECT_EQ(said.out, "");
  EXPECT_NE(said.err.find("none.lcmlog: No such file"), std::string::npos) << said.err;
  EXPECT_NE(said.err.find("nor.lcmlog"), std::string::npos) << said.err;
  const test::ShellResult bad =
      test::shell(directory_, "$F fleet manifest none.toml out rec.lcmlog");
  EXPECT_EQ(bad.status, 2);
  EXPECT_NE(bad.err.find("none.toml"), std::string::npos) << bad.err;
}

}  // namespace task_command_test
}  // namespace framewatch::fleet
