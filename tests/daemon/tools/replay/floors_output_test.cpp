// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/floors_output.h"

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/tools/lab/few_sensors.h"
#include "daemon/tools/replay/replay_command.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace floors_output_test {

constexpr double kRate_hz = 100;

/// The base and floors 2, 4 and 6 of six have channels.
TallRecord six_stories() {
  TallTrial trial;
  trial.stories = 6;
  trial.floors = {2, 4, 6};
  trial.noise_ratio = 0;
  trial.stiffness_off = trial.damping_off = 0;
  trial.duration_s = 30;
  return tall_record(trial);
}

std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
  std::vector<std::vector<std::string>> out;
  std::stringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    out.emplace_back();
    std::stringstream cells(line + ",");
    for (std::string cell; std::getline(cells, cell, ',');) out.back().push_back(cell);
  }
  return out;
}

std::vector<std::vector<std::string>> written(const TallRecord& record) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("floors.csv");
  FloorsOutput output(record.config);
  EXPECT_TRUE(output.open(path)) << output.error();
  estimator::SampleSet set;
  for (Eigen::Index i = 0; i < record.accel.rows(); ++i) {
    set.index = i;
    set.time = estimator::from_microseconds(std::llround(1e6 * static_cast<double>(i) / kRate_hz));
    set.accel.assign(record.accel.row(i).begin(), record.accel.row(i).end());
    EXPECT_TRUE(output.put(set));
  }
  EXPECT_TRUE(output.close());
  return cells_of(test::read_file(path));
}

TEST(FloorsOutput, HasEveryFloorAndStory) {
  const auto cells = written(six_stories());
  ASSERT_EQ(cells.size(), 3002u);
  ASSERT_EQ(cells[0].size(), 1u + 7 + 6);
  EXPECT_EQ(cells[0][0], "time_s");
  EXPECT_EQ(cells[0][1], "accel_0_y1_mps2");
  EXPECT_EQ(cells[0][7], "accel_6_y1_mps2");
  EXPECT_EQ(cells[0][8], "drift_1_y1_ratio");
  EXPECT_EQ(cells[3001][0], "30");
}

TEST(FloorsOutput, GivesMeasuredFloorsAsMeasuredAndInterpolatesOthers) {
  constexpr double kDigits = 1e-4;  // m/s^2
  const TallRecord record = six_stories();
  const auto cells = written(record);
  double largest[7] = {};
  for (std::size_t i = 2000; i < 3000; ++i) {
    for (std::size_t floor = 0; floor <= 6; ++floor)
      largest[floor] = std::max(largest[floor], std::abs(std::stod(cells[i + 1][1 + floor])));
    for (const auto& [floor, axis] : {std::pair(2, 1), std::pair(4, 2), std::pair(6, 3)})
      EXPECT_NEAR(std::stod(cells[i + 1][std::size_t(1 + floor)]),
                  record.accel(static_cast<Eigen::Index>(i), axis), kDigits);
    EXPECT_FALSE(cells[i + 1][8].empty());
  }
  for (const double peak : largest) EXPECT_GT(peak, 0.1);
}

TEST(FloorsOutput, LeavesUnknownValuesEmpty) {
  TallRecord record = six_stories();
  record.accel.col(0).setConstant(std::nan(""));
  const auto cells = written(record);
  EXPECT_EQ(cells[2500][1], "");
  EXPECT_EQ(cells[2500][8], "");
}

TEST(FloorsOutput, ReportsWhereItCannotWrite) {
  FloorsOutput output(six_stories().config);
  EXPECT_FALSE(output.open("/nowhere/floors.csv"));
  EXPECT_NE(output.error().find("/nowhere/floors.csv"), std::string::npos);
}

TEST(ReplayFloors, RefusesAnotherFileEnding) {
  ReplayArguments arguments;
  arguments.config = "c.toml";
  arguments.inputs = {"in.csv"};
  for (const char* good : {"f.csv", "f.csv.gz", "-"}) {
    arguments.floors = good;
    EXPECT_TRUE(argument_problems(arguments).empty()) << good;
  }
  for (const char* bad : {"f.mat", "f", "in.csv"}) {
    arguments.floors = bad;
    EXPECT_FALSE(argument_problems(arguments).empty()) << bad;
  }
  arguments.out = arguments.floors = "f.csv";
  EXPECT_FALSE(argument_problems(arguments).empty());
}

}  // namespace floors_output_test
}  // namespace framewatch::daemon
