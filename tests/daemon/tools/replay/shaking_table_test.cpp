// SPDX-License-Identifier: MIT
// The measured three-story table of data/mini_shake_table_xsens_2025, through the shipped
// configuration. Reference: peaks of the measured transfer functions, 3.69, 11.2 and 16.6 Hz in the
// Northridge run (the data's PROVENANCE.txt). docs/shaking-table.md discusses the numbers.

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "daemon/config/config.h"
#include "daemon/tools/lab/data_files.h"
#include "estimator/numeric/quantile.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/support/data.h"

namespace framewatch {
namespace shaking_table_test {

struct Identified {
  std::vector<double> stiffness;  ///< N/m for 1 kg floors: median over published windows
  std::vector<double> mode_hz;
};

std::optional<drivers::Record> read_run(const std::string& run) {
  const auto data = test::data_path("");
  for (const daemon::MeasuredRun& known : daemon::measured_runs())
    if (data && known.name == run) return daemon::read_measured_run(*data, known);
  return std::nullopt;
}

Identified identify(const drivers::Record& record) {
  std::vector<daemon::ConfigProblem> problems;
  const auto config = daemon::load_config(
      std::string(FRAMEWATCH_SOURCE_DIR) + "/configs/mini_shake_table_xsens.toml", problems);
  if (!config) return {};
  std::vector<std::vector<double>> published(3);
  const auto take = [&](const estimator::WindowEstimate& estimate) {
    for (std::size_t i = 0; i < 3; ++i)
      if (!std::isnan(estimate.value[i])) published[i].push_back(estimate.value[i]);
  };
  estimator::Pipeline pipeline(config->pipeline);
  for (std::size_t t = 0; t < record.time_s.size(); ++t)
    for (std::size_t a = 0; a < record.names.size(); ++a)
      estimator::each_main_window(
          pipeline.push({estimator::from_microseconds(std::llround(record.time_s[t] * 1e6)),
                         static_cast<int>(a), record.accel_mps2[a][t]}),
          take);
  estimator::each_main_window(pipeline.finish(), take);
  Identified out;
  Eigen::VectorXd theta = Eigen::VectorXd::Ones(6);
  for (std::size_t i = 0; i < 3; ++i) {
    if (published[i].empty()) return {};
    out.stiffness.push_back(estimator::upper_median(published[i]));
    theta[static_cast<Eigen::Index>(i)] = out.stiffness.back();
  }
  out.mode_hz = natural_frequencies_hz(config->pipeline.structure, pipeline.parameters(), theta);
  return out;
}

TEST(ShakingTable, ModesOfTheNorthridgeRunMatchTheTransferFunctions) {
  const auto record = read_run("Northridge");
  if (!record) GTEST_SKIP() << "no measured table under FRAMEWATCH_DATA";
  const Identified found = identify(*record);
  ASSERT_EQ(found.mode_hz.size(), 3u);
  EXPECT_NEAR(found.mode_hz[0], 3.69, 0.03 * 3.69);
  EXPECT_NEAR(found.mode_hz[1], 11.2, 0.10 * 11.2);
  EXPECT_NEAR(found.mode_hz[2], 16.6, 0.10 * 16.6);
}

TEST(ShakingTable, RunsDifferOnlyAsTheAmplitudeExplains) {
  // Amplitude explains 6 % in stiffness (the first mode falls from 3.81 to 3.69 Hz); the 1.5-Hz run
  // excites mode 3 most, where this table is stiffer (docs/shaking-table.md). Together: every story
  // of every run within 12 % of the runs' mean, and the strongest run the softest.
  std::map<std::string, Identified> found;
  for (const daemon::MeasuredRun& measured : daemon::measured_runs()) {
    const std::string& run = measured.name;
    const auto record = read_run(run);
    if (!record) GTEST_SKIP() << "no measured table under FRAMEWATCH_DATA";
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

}  // namespace shaking_table_test
}  // namespace framewatch
