// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/shell.h"

namespace framewatch::daemon {
namespace new_users_way_test {

// Limits.
constexpr double kMost_s = 300;           // for the four commands, on a busy machine
constexpr double kStiffnessError = 0.03;  // of the mean over all windows

/// Two stories, one bay each way, shaken for a minute. Its stiffnesses differ by 1.5 to 3 times
/// from the rule of thumb with which init starts. Written as a logger's file.
constexpr const char* kShaken = R"(config = "truth.toml"
duration_s = 60
seed = 7

[truth]
kx_npm = [[20e6, 14e6], [16e6, 12e6]]
ky_npm = [[30e6, 36e6], [26e6, 31e6]]
gk = 20e6
damping_ratio = 0.02

[motion]
angle_deg = 40.0
peak_mps2 = 2.0

[sensors]
noise_ratio = 0.01
)";

constexpr const char* kLogger =
    R"(awk -F, 'NR == 1 { printf "Time"; for (i = 2; i <= NF; ++i) printf ";%s [g]", $i; print "" }
  NR > 1 { printf "%.4f", $1; for (i = 2; i <= NF; ++i) printf ";%.9f", $i / 9.80665; print "" }' \
  record.csv | sed '2,$s/\./,/g' >logger.csv)";

constexpr const char* kShape =
    "--stories 2 --bays 1x1 --span-x 6 --span-y 4 --heights 3.5 --mass 300kg/m2 ";

class NewUsersWay : public testing::Test {
 protected:
  test::ShellResult shell(const std::string& line) { return test::shell(directory_, line); }

  /// Writes logger.csv, with columns that `sed` renames from base-x, F1-Y1, ...
  void log_as(const std::string& sed) {
    test::write_file(directory_.path("shaken.toml"), kShaken);
    const test::ShellResult made =
        shell(std::string("set -e; $F init --live none --start none --out truth.toml --quiet ") +
              kShape + "\n$F simulate shaken.toml --out record.csv --quiet\nsed -i '1{" + sed +
              "}' record.csv\n" + kLogger);
    ASSERT_EQ(made.status, 0) << made.err;
  }

  /// Returns the mean of a column of a CSV file over rows with a value.
  double mean(const std::string& name) {
    std::istringstream lines(test::read_file(directory_.path("estimates.csv")));
    std::string line, cell;
    std::getline(lines, line);
    std::istringstream header(line);
    int column = 0;
    for (; std::getline(header, cell, ',') && cell != name;) ++column;
    double sum = 0, count = 0;
    while (std::getline(lines, line)) {
      std::istringstream row(line);
      for (int i = 0; i <= column; ++i) std::getline(row, cell, ',');
      if (cell.empty()) continue;
      sum += std::stod(cell);
      ++count;
    }
    EXPECT_GT(count, 0) << name;
    return sum / count;
  }

  void check_replay_report() {
    EXPECT_EQ(shell("$F check building.toml").status, 0);
    const test::ShellResult replay =
        shell("$F replay building.toml logger.csv --out estimates.lcmlog");
    ASSERT_EQ(replay.status, 0) << replay.err;
    const test::ShellResult report = shell("$F report estimates.lcmlog --out report.html");
    ASSERT_EQ(report.status, 0) << report.err;
  }

  test::TemporaryDirectory directory_;
};

TEST_F(NewUsersWay, LeadsFromARecordToAPlotOfStiffnesses) {
  log_as("s/base-\\([xy]\\)/base_\\1/g; s/F\\([12]\\)-\\([XY][12]\\)/story \\1 frame \\L\\2/g");
  ASSERT_TRUE(test::read_file(directory_.path("logger.csv"))
                  .starts_with("Time;base_x [g];base_y [g];story 1 frame y1 [g];"));
  const auto start = std::chrono::steady_clock::now();
  const test::ShellResult init = shell(std::string("$F init --record logger.csv ") + kShape);
  ASSERT_EQ(init.status, 0) << init.err;
  check_replay_report();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), kMost_s);
  RecordProperty("seconds", std::to_string(took.count()));
  const std::string report = test::read_file(directory_.path("report.html"));
  for (const char* part :
       {"<h2>Identified stiffness and damping</h2>", "<svg", "kx_1_y1", "ky_2_x2"})
    EXPECT_NE(report.find(part), std::string::npos) << part;
  ASSERT_EQ(shell("$F convert estimates.lcmlog estimates.csv").status, 0);
  const std::vector<std::pair<const char*, double>> truth = {
      {"kx_1_y1", 20e6}, {"kx_1_y2", 14e6}, {"kx_2_y1", 16e6}, {"kx_2_y2", 12e6},
      {"ky_1_x1", 30e6}, {"ky_1_x2", 36e6}, {"ky_2_x1", 26e6}, {"ky_2_x2", 31e6}};
  for (const auto& [name, stiffness] : truth)
    EXPECT_NEAR(mean(name), stiffness, kStiffnessError * stiffness) << name;
}

TEST_F(NewUsersWay, DoesNotGuessAmbiguousTitles) {
  log_as("s/base-\\([xy]\\)/base_\\1/g; s/F\\([12]\\)-\\([XY][12]\\)/A\\1\\2/g");
  const std::string init = std::string("$F init --record logger.csv ") + kShape;
  const test::ShellResult asked = shell(init);
  EXPECT_EQ(asked.status, 2);
  EXPECT_NE(asked.err.find("A1Y1 can be read in two ways"), std::string::npos) << asked.err;
  const test::ShellResult said = shell(init + "--titles frames");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.out.find("A2X1             floor 2, frame x1, along y"), std::string::npos)
      << said.out;
  check_replay_report();
}

TEST_F(NewUsersWay, LeadsFromALoggersFileToAClientsPdfWithModesInFourCommands) {
  // GIVEN a logger's file with German titles and time stamps, a comma in every number
  log_as("s/base-\\([xy]\\)/Fundament \\U\\1/g; s/F\\([12]\\)-\\([XY][12]\\)/\\1. OG \\L\\2/g");
  ASSERT_EQ(
      shell("awk -F';' -v OFS=';' 'NR > 1 { t = $1; sub(/,/, \".\", t); "
            "$1 = sprintf(\"2026-11-21 14:%02d:%07.4f\", t / 60, t % 60); sub(/\\./, \",\", $1) } "
            "{ print }' logger.csv >stamped.csv")
          .status,
      0);
  const std::string head = test::read_file(directory_.path("stamped.csv")).substr(0, 400);
  ASSERT_NE(head.find("Fundament X [g];Fundament Y [g];1. OG y1 [g]"), std::string::npos) << head;
  ASSERT_NE(head.find("\n2026-11-21 14:00:00,0000;"), std::string::npos) << head;
  // WHEN the commands of docs/laboratory.md are given, those after the first as init prints them
  const test::ShellResult init =
      shell(std::string("$F init --record stamped.csv --zone +01:00 --titles frames ") + kShape);
  ASSERT_EQ(init.status, 0) << init.err;
  const std::string record = "stamped.csv --zone +01:00";
  const std::string replay =
      "framewatch replay building.toml " + record + " --out estimates.lcmlog";
  const std::string report = "framewatch report estimates.lcmlog --config building.toml --raw " +
                             record + " --out report.html";
  for (const std::string& step : {replay, report})
    EXPECT_NE(init.out.find("\n  " + step + "\n"), std::string::npos) << init.out;
  EXPECT_EQ(shell("$F check building.toml").status, 0) << "without an edit";
  ASSERT_EQ(shell("$F" + replay.substr(10)).status, 0);
  const test::ShellResult reported = shell("$F" + report.substr(10) + " --figures figures");
  if (reported.err.find("librsvg2-2") != std::string::npos) GTEST_SKIP() << reported.err;
  ASSERT_EQ(reported.status, 0) << reported.err;
  // THEN the page has the modes, and the folder of figures has a picture of each
  const std::string page = test::read_file(directory_.path("report.html"));
  EXPECT_NE(page.find(">Modes</h2>"), std::string::npos);
  EXPECT_NE(page.find(">mode 6 ("), std::string::npos) << "the last one with a picture";
  EXPECT_EQ(shell("ls figures/mode-1.csv figures/mode-8-2col.svg").status, 0);
  // and a browser prints it
  if (shell("command -v chromium").status != 0) GTEST_SKIP() << "no chromium prints the page";
  const test::ShellResult printed = shell(
      "chromium --no-sandbox --headless --no-pdf-header-footer --print-to-pdf=report.pdf "
      "report.html");
  if (printed.status != 0) GTEST_SKIP() << "chromium does not start here: " << printed.err;
  const std::string pdf = test::read_file(directory_.path("report.pdf"));
  EXPECT_EQ(pdf.rfind("%PDF-", 0), 0u);
  EXPECT_GT(std::count(pdf.begin(), pdf.end(), '\n'), 100);
}

TEST_F(NewUsersWay, PassesRecordOptionsToReplay) {
  log_as("s/base-\\([xy]\\)/base_\\1/g; s/F\\([12]\\)-\\([XY][12]\\)/story \\1 frame \\L\\2/g");
  ASSERT_EQ(shell("sed -i '1s/ \\[g\\]//g' logger.csv").status, 0);
  const std::string init = std::string("$F init --record logger.csv ") + kShape;
  EXPECT_NE(shell(init).err.find("--unit g"), std::string::npos);
  const test::ShellResult said = shell(init + "--unit g");
  ASSERT_EQ(said.status, 0) << said.err;
  EXPECT_NE(said.out.find("framewatch replay building.toml logger.csv --unit g --out"),
            std::string::npos)
      << said.out;
  EXPECT_EQ(shell("$F replay building.toml logger.csv").status, 2);
  EXPECT_EQ(shell("$F replay building.toml logger.csv --unit g --out estimates.lcmlog").status, 0);
  EXPECT_EQ(shell("$F report estimates.lcmlog --config building.toml --raw logger.csv").status, 2);
  EXPECT_EQ(
      shell("$F report estimates.lcmlog --config building.toml --raw logger.csv --unit g").status,
      0);
  EXPECT_EQ(shell("$F refine building.toml logger.csv --unit g --from 20").status, 0);
  EXPECT_EQ(shell("$F replay building.toml logger.csv --unit furlong").err,
            "--unit: 'furlong' is not g, mg, gal or mps2, nor a number of m/s^2\n");
  const test::ShellResult log = shell(
      "$F convert logger.csv --unit g --config building.toml l.lcmlog; "
      "$F replay building.toml l.lcmlog --unit g");
  EXPECT_EQ(log.status, 2);
  EXPECT_NE(log.err.find("are for record files"), std::string::npos) << log.err;
}

}  // namespace new_users_way_test
}  // namespace framewatch::daemon
