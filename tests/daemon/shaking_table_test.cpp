// The measured three-story table of data/mini_shake_table_xsens_2025, through the shipped
// configuration. Reference: peaks of the measured transfer functions, 3.69, 11.2 and 16.6 Hz in the
// Northridge run (the data's PROVENANCE.txt). docs/shaking-table.md discusses the numbers.

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "daemon/config.h"
#include "drivers/record_file.h"
#include "drivers/record_merge.h"
#include "estimator/structure/matrices.h"
#include "tests/support/data.h"

namespace framewatch {
namespace {

const std::string kFolder = "mini_shake_table_xsens_2025/Flexible_vs_Stiff/Flexible_3_story/";

/// File of each level, from the ground up, of one run.
const std::map<std::string, std::vector<std::string>> kRuns = {
    {"Northridge",
     {"Ground_Floor/(Northridge)Xsens_DOT_20250306_122607.csv.gz",
      "1st_Floor/(Northridge)Xsens_DOT_20250306_122607.csv.gz",
      "2nd_Floor/(Northridge)left_leg_20250306_122607.csv.gz",
      "3rd_Floor_top/(Northridge)Xsens_DOT_20250306_122607.csv.gz"}},
    {"Sine_1.0",
     {"Ground_Floor/(Sine_1.0)Xsens_DOT_20250306_122116.csv.gz",
      "1st_Floor/(Sine_1.0)Xsens_DOT_20250306_122116.csv.gz",
      "2nd_Floor/(Sine_1.0)left_leg_20250306_122116.csv.gz",
      "3rd_Floor_top/(Sine_1.0)Xsens_DOT_20250306_122116.csv.gz"}},
    {"Sine_1.5",
     {"Ground_Floor/(Sine_1.5)Xsens_DOT_20250306_121949.csv.gz",
      "1st_Floor/(Sine_1.5)Xsens_DOT_20250306_121949.csv.gz",
      "2nd_Floor/(Sine_1.5)left_leg_20250306_121949.csv.gz",
      "3rd_Floor_top/(Sine_1.5)Xsens_DOT_20250306_121949.csv.gz"}},
    {"Sine_2.0",
     {"Ground_Floor/(Sine_2.0)Xsens_DOT_20250306_122410.csv.gz",
      "1st_Floor/(Sine_2.0)Xsens_DOT_20250306_122410.csv.gz",
      "2nd_Floor/(Sine_2.0)left_leg_20250306_122410.csv.gz",
      "3rd_Floor_top/(Sine_2.0)Xsens_DOT_20250306_122410.csv.gz"}}};

struct Identified {
  std::vector<double> stiffness;  ///< N/m for 1 kg floors: median over published windows
  std::vector<double> mode_hz;
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

std::optional<drivers::Record> read_run(const std::string& run) {
  std::vector<drivers::Record> levels;
  std::vector<std::string> where;
  std::vector<drivers::Problem> problems;
  for (const std::string& file : kRuns.at(run)) {
    const auto path = test::data_path(kFolder + file);
    if (!path) return std::nullopt;
    auto record = drivers::read_record(*path, {}, problems);
    if (!record) return std::nullopt;
    const std::string level = "level" + std::to_string(levels.size());
    const auto x = std::find_if(record->names.begin(), record->names.end(), [](const auto& name) {
      return name.ends_with(".x") || name.ends_with("_X") || name == "x";
    });
    if (x == record->names.end()) return std::nullopt;
    record->accel_mps2 = {record->accel_mps2[static_cast<std::size_t>(x - record->names.begin())]};
    record->names = {level};
    levels.push_back(std::move(*record));
    where.push_back(file);
  }
  return drivers::merge_records(std::move(levels), where, drivers::MergeSpan::common, problems);
}

Identified identify(const drivers::Record& record) {
  std::vector<daemon::ConfigProblem> problems;
  const auto config = daemon::load_config(
      std::string(FRAMEWATCH_SOURCE_DIR) + "/configs/mini_shake_table_xsens.toml", problems);
  if (!config) return {};
  std::vector<std::vector<double>> published(3);
  Pipeline pipeline(config->pipeline, [&](const WindowEstimate& estimate) {
    for (std::size_t i = 0; i < 3; ++i)
      if (!std::isnan(estimate.value[i])) published[i].push_back(estimate.value[i]);
  });
  for (std::size_t t = 0; t < record.time_s.size(); ++t)
    for (std::size_t a = 0; a < record.names.size(); ++a)
      pipeline.push({from_microseconds(std::llround(record.time_s[t] * 1e6)), static_cast<int>(a),
                     record.accel_mps2[a][t]});
  pipeline.finish();
  Identified out;
  Eigen::VectorXd theta = Eigen::VectorXd::Ones(6);
  for (std::size_t i = 0; i < 3; ++i) {
    if (published[i].empty()) return {};
    out.stiffness.push_back(median(published[i]));
    theta[static_cast<Eigen::Index>(i)] = out.stiffness.back();
  }
  out.mode_hz = natural_frequencies_hz(config->pipeline.structure, pipeline.parameters(), theta);
  return out;
}

TEST(ShakingTable, ModesOfTheNorthridgeRunMatchTheTransferFunctions) {
  const auto record = read_run("Northridge");
  if (!record) GTEST_SKIP() << "no " << kFolder << " under FRAMEWATCH_DATA";
  const Identified found = identify(*record);
  ASSERT_EQ(found.mode_hz.size(), 3u);
  EXPECT_NEAR(found.mode_hz[0], 3.69, 0.03 * 3.69);
  EXPECT_NEAR(found.mode_hz[1], 11.2, 0.10 * 11.2);
  EXPECT_NEAR(found.mode_hz[2], 16.6, 0.10 * 16.6);
}

TEST(ShakingTable, RunsDifferByWhatTheAmplitudeExplains) {
  // Amplitude explains 6 % in stiffness (the first mode falls from 3.81 to 3.69 Hz); the 1.5-Hz run
  // excites mode 3 most, where this table is stiffer (docs/shaking-table.md). Together: every story
  // of every run within 12 % of the runs' mean, and the strongest run the softest.
  std::map<std::string, Identified> found;
  for (const auto& [run, files] : kRuns) {
    const auto record = read_run(run);
    if (!record) GTEST_SKIP() << "no " << kFolder << " under FRAMEWATCH_DATA";
    found[run] = identify(*record);
    ASSERT_EQ(found[run].stiffness.size(), 3u) << run;
  }
  for (std::size_t story = 0; story < 3; ++story) {
    double mean = 0;
    for (const auto& [run, result] : found) mean += result.stiffness[story] / 4;
    for (const auto& [run, result] : found) {
      RecordProperty(run + "_k" + std::to_string(story + 1),
                     std::to_string(result.stiffness[story]));
      EXPECT_NEAR(result.stiffness[story], mean, 0.12 * mean) << run << " story " << story + 1;
    }
  }
  for (const char* sine : {"Sine_1.0", "Sine_1.5", "Sine_2.0"})
    EXPECT_LT(found["Northridge"].mode_hz[0], found[sine].mode_hz[0]) << sine;
}

}  // namespace
}  // namespace framewatch
