// SPDX-License-Identifier: MIT
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/base/exit_code.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace strange_inputs_test {

constexpr int kPatience_s = 60;  // a FIFO that is opened blocks forever; measured 0.1 s
constexpr int kTimedOut = 124;   // of timeout(1)

struct Said {
  int status;
  std::string text;
};

/// A path that is not a file, and the words that must describe it.
struct Strange {
  const char* name;
  const char* word;
};
constexpr Strange kStrange[] = {{"fifo", "is a FIFO, not a file"},
                                {"folder", "is a directory, not a file"},
                                {"zeros", "is a device, not a file"},
                                {"loop", "Too many levels of symbolic links"},
                                {"none", "No such file or directory"}};

class StrangeInputs : public testing::Test {
 protected:
  static std::string source(const std::string& name) { return FRAMEWATCH_SOURCE_DIR "/" + name; }

  void make(const std::string& path, const std::string& kind) {
    std::filesystem::remove_all(path);
    if (kind == "fifo") {
      EXPECT_EQ(::mkfifo(path.c_str(), 0600), 0);
    }
    if (kind == "folder") std::filesystem::create_directory(path);
    if (kind == "zeros") std::filesystem::create_symlink("/dev/zero", path);
    if (kind == "loop") std::filesystem::create_symlink(path, path);
    if (kind == "empty") test::write_file(path, "");
  }

  /// Runs a command in the test's directory.
  Said run(const std::string& command) {
    const int status =
        std::system(fmt::format("cd {} && timeout {} {} {} </dev/null >said 2>&1",
                                directory_.path(""), kPatience_s, FRAMEWATCH_PROGRAM, command)
                        .c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, test::read_file(directory_.path("said"))};
  }

  /// Each command must refuse every strange path at `file` and describe it.
  void expect_refused(const std::string& file, const std::vector<std::string>& commands,
                      bool absent_is_refused = true) {
    for (const Strange& strange : kStrange) {
      if (!absent_is_refused && std::string(strange.name) == "none") continue;
      for (const std::string& command : commands) {
        make(directory_.path(file), strange.name);
        const Said said = run(command);
        EXPECT_NE(said.status, kTimedOut) << command << ": hangs on a " << strange.name;
        EXPECT_EQ(said.status, kBadInput) << command << "\n" << said.text;
        EXPECT_NE(said.text.find(strange.word), std::string::npos) << command << "\n" << said.text;
        EXPECT_NE(said.text.find(file), std::string::npos) << command << "\n" << said.text;
      }
    }
    for (const std::string& command : commands) {
      make(directory_.path(file), "empty");
      const Said said = run(command);
      EXPECT_EQ(said.status, kBadInput) << command << " of an empty file\n" << said.text;
      EXPECT_FALSE(said.text.empty()) << command;
    }
  }

  void SetUp() override {
    std::filesystem::copy(source("configs/table_two_story.toml"), directory_.path("table.toml"));
    std::filesystem::copy(source("configs/can/raw_int16.toml"), directory_.path("can.toml"));
    std::filesystem::copy(source("tests/golden/table.lcmlog.zst"),
                          directory_.path("raw.lcmlog.zst"));
    test::write_file(directory_.path("rec.csv"), "time_s,a\n0,1\n0.01,2\n0.02,1\n");
  }

  test::TemporaryDirectory directory_;
};

TEST_F(StrangeInputs, AsAConfiguration) {
  expect_refused("x", {"check x", "run x --quiet", "serve x", "status x", "tell x", "record x",
                       "replay x raw.lcmlog.zst --out o.csv", "refine x raw.lcmlog.zst",
                       "diagnose x --train rec.csv --holdout rec.csv --out d", "adopt x x",
                       "convert rec.csv o.lcmlog --config x"});
}

TEST_F(StrangeInputs, AsALogOrRecord) {
  const std::vector<std::string> commands{"replay table.toml x --out o.csv",
                                          "replay table.toml raw.lcmlog.zst x --out o.csv",
                                          "refine table.toml x",
                                          "diagnose table.toml --train x --holdout rec.csv --out d",
                                          "repair x",
                                          "repair x --check --json",
                                          "diff x raw.lcmlog.zst",
                                          "convert x o.csv",
                                          "convert x o.lcmlog",
                                          "convert rec.csv x o.lcmlog",
                                          "convert x o.csv --format at2",
                                          "convert x o.csv --format xsens",
                                          "convert x o.csv --format rows --unit g --step 0.01",
                                          "convert x o.csv --format two-columns --unit g",
                                          "report x",
                                          "simulate x --out o.csv"};
  expect_refused("x", commands);
  EXPECT_FALSE(std::filesystem::exists(directory_.path("o.csv")));
  EXPECT_FALSE(std::filesystem::exists(directory_.path("o.lcmlog")));
}

TEST_F(StrangeInputs, ByTheirEndings) {
  std::filesystem::copy(source("configs/can/raw_int16.dbc"), directory_.path("raw_int16.dbc"));
  expect_refused("x.csv.gz", {"convert x.csv.gz o.lcmlog", "replay table.toml x.csv.gz --quiet"});
  expect_refused("x.lcmlog.zst", {"convert x.lcmlog.zst o.csv", "repair x.lcmlog.zst"});
  expect_refused("can.log", {"replay can.toml can.log --quiet"});
}

TEST_F(StrangeInputs, NamedByAConfigurationOrScenario) {
  expect_refused("raw_int16.dbc", {"check can.toml"});
  test::write_file(directory_.path("s.toml"),
                   "config = \"table.toml\"\nduration_s = 1\n[motion]\nfile = \"motion.csv\"\n");
  expect_refused("motion.csv", {"simulate s.toml --out o.csv"});
  const std::string table = test::read_file(directory_.path("table.toml"));
  test::write_file(directory_.path("watch.toml"),
                   table + "\n[watch]\nbaseline = \"baseline.toml\"\n");
  expect_refused("baseline.toml", {"check watch.toml"}, false);
  test::write_file(directory_.path("gap.toml"), table + "\n[gap]\nmodel = \"model.toml\"\n");
  expect_refused("model.toml", {"check gap.toml"}, false);
}

TEST_F(StrangeInputs, BesideALog) {
  expect_refused("x", {"replay table.toml raw.lcmlog.zst --quiet --to 1 --load-state x",
                       "replay table.toml raw.lcmlog.zst --quiet --to 1 --expect x"});
  ASSERT_EQ(run("replay table.toml raw.lcmlog.zst --quiet --out est.lcmlog").status, 0);
  test::write_file(directory_.path("gap.toml"), test::read_file(directory_.path("table.toml")) +
                                                    "\n[gap]\nmodel = \"model.toml\"\n");
  expect_refused("x", {"report est.lcmlog --config x", "report est.lcmlog --session x",
                       "report est.lcmlog --config table.toml --raw x", "diff est.lcmlog x",
                       "adopt gap.toml x"});
}

TEST_F(StrangeInputs, AsTheStateOfADaemon) {
  for (const Strange& strange : kStrange) {
    if (std::string(strange.name) == "none") continue;
    make(directory_.path("x"), strange.name);
    const Said said = run("run table.toml --quiet --state x");
    EXPECT_EQ(said.status, kBadInput) << strange.name << "\n" << said.text;
    EXPECT_NE(said.text.find(strange.word), std::string::npos) << said.text;
  }
  EXPECT_FALSE(std::filesystem::exists(directory_.path("x.refused")));
}

TEST_F(StrangeInputs, InAFolderOfAHistoryOrSession) {
  std::filesystem::create_directories(directory_.path("h/raw"));
  expect_refused("h/history.sqlite", {"history h --out o.csv", "history h --json"}, false);
  std::filesystem::create_directory(directory_.path("session"));
  expect_refused("session/session.json", {"record table.toml --finish session"});
  std::filesystem::remove_all(directory_.path("h/history.sqlite"));
  for (const char* kind : {"fifo", "folder", "zeros", "loop"}) {
    make(directory_.path("h/raw/20261121T230000Z.lcmlog"), kind);
    EXPECT_EQ(run("history h --raw o.csv").status, kBadInput) << kind;
    EXPECT_FALSE(std::filesystem::exists(directory_.path("o.csv")));
  }
}

}  // namespace strange_inputs_test
}  // namespace framewatch::daemon
