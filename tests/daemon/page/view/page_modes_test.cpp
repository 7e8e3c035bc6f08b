// SPDX-License-Identifier: MIT
#include "daemon/page/view/page_modes.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/page/view/mode_errors.h"
#include "daemon/page/view/page_json.h"
#include "daemon/tools/lab/accuracy_trial.h"
#include "estimator/identify/elements/story_design.h"
#include "estimator/simulate/ground_motion.h"
#include "tests/support/config_fixture.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::daemon {
namespace page_modes_test {

constexpr double kInterval = 1.96;  // standard errors that cover 95 %
constexpr double kLeastCoverage = 0.90, kMostCoverage = 0.99;
constexpr double kStep = 1e-4;        // relative
constexpr double kSlopeError = 1e-3;  // relative

Config two_stories() {
  std::vector<ConfigProblem> problems;
  auto config = load_config(FRAMEWATCH_SOURCE_DIR "/configs/table_two_story.toml", problems);
  EXPECT_TRUE(config) << test::told(problems);
  return *config;
}

/// Returns the design as values of windows that end at 5 s, with 1 % of error.
NewestValues designed(const Config& config) {
  const Eigen::VectorXd& design = config.pipeline.design;
  NewestValues out;
  for (const double value : design) {
    out.value.push_back(value);
    out.std_error.push_back(0.01 * value);
    out.end_us.push_back(5'000'000);
  }
  return out;
}

std::size_t index_of(const Config& config, const char* name) {
  return static_cast<std::size_t>(config.pipeline.parameters().find(name).value());
}

void forget(NewestValues& values, std::size_t p) {
  values.value[p] = values.std_error[p] = NAN;
  values.end_us[p] = 0;
}

TEST(PageModes, AreThoseOfTheNewestValues) {
  const Config config = two_stories();
  NewestValues values = designed(config);
  values.end_us[3] = 4'000'000;
  const PageModes found = page_modes(config, values);
  EXPECT_EQ(found.why, "");
  EXPECT_EQ(found.why_no_damping, "");
  EXPECT_EQ(found.oldest_us, 4'000'000);
  const auto expected =
      natural_modes(config.pipeline.structure, config.pipeline.parameters(),
                    estimator::story_design(config.pipeline), config.pipeline.design);
  ASSERT_EQ(found.modes.size(), 8u);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(found.modes[i].frequency_hz, expected.modes[i].frequency_hz);
    EXPECT_EQ(found.modes[i].shape, expected.modes[i].shape);
  }
}

TEST(PageModes, HaveTheErrorThatAValueCauses) {
  const Config config = two_stories();
  const std::size_t p = index_of(config, "kx_1_y1");
  NewestValues values = designed(config);
  const auto hz_of = [&](double factor) {
    NewestValues changed = values;
    changed.value[p] *= factor;
    return page_modes(config, changed).modes[0].frequency_hz;
  };
  const double slope = (hz_of(1 + kStep) - hz_of(1 - kStep)) / (2 * kStep * values.value[p]);
  values.std_error.assign(values.std_error.size(), 0);
  values.std_error[p] = 0.01 * values.value[p];
  const double expected_hz = std::abs(slope) * values.std_error[p];
  ASSERT_GT(expected_hz, 0);
  EXPECT_NEAR(page_modes(config, values).modes[0].frequency_error_hz, expected_hz,
              kSlopeError * expected_hz);
}

TEST(PageModes, SayWhatIsMissing) {
  Config config = two_stories();
  EXPECT_EQ(page_modes(config, {}).why, "no window has values yet");
  const NewestValues all = designed(config);
  NewestValues values = all;
  // A floor panel has the design's value, and its error.
  forget(values, index_of(config, "Gk_1_x1y1"));
  const PageModes of_design = page_modes(config, values);
  ASSERT_FALSE(of_design.modes.empty()) << of_design.why;
  for (const auto& [error_hz, of_ratio] : page_modes(config, all).other_errors)
    EXPECT_EQ(error_hz, 0);
  double guessed_hz = 0;
  for (const auto& [error_hz, of_ratio] : of_design.other_errors) guessed_hz += error_hz;
  EXPECT_GT(guessed_hz, 0.1);
  // Without a value of one frame's damping, no mode has a damping ratio.
  forget(values, index_of(config, "cy_2_x1"));
  const PageModes undamped = page_modes(config, values);
  EXPECT_EQ(undamped.modes.size(), 8u);
  EXPECT_EQ(undamped.why_no_damping, "story 2, frame x1 (cy_2_x1) has no value yet");
  const auto json = nlohmann::json::parse(modes_json(undamped));
  EXPECT_TRUE(json["modes"][0]["ratio"].is_null());
  EXPECT_NEAR(json["modes"][0]["hz"], undamped.modes[0].frequency_hz, 1e-12);
  EXPECT_EQ(json["modes"][0]["re"].size(), 8u);
  // A frame's stiffness is the reason why there are no modes.
  forget(values, index_of(config, "kx_1_y2"));
  const PageModes none = page_modes(config, values);
  EXPECT_TRUE(none.modes.empty());
  EXPECT_EQ(none.why, "story 1, frame y2 (kx_1_y2) has no value yet");
  // So is a panel without a design.
  values = all;
  forget(values, index_of(config, "Gk_1_x1y1"));
  config.pipeline.design.resize(0);
  EXPECT_EQ(page_modes(config, values).why, "floor 1, panel x1y1 (Gk_1_x1y1) has no value yet");
}

TEST(PageModes, AreNotComputedForLargeBuildings) {
  Config config = test::good(test::kGoodConfig);
  config.pipeline.structure.stories = kMostPageFreedoms / 4 + 1;
  EXPECT_NE(page_modes(config, {}).why.find("more than 120 degrees of freedom"), std::string::npos);
}

/// Takes the values of a window as PageHistory does.
void take(const estimator::WindowEstimate& e, NewestValues& newest) {
  newest.value.resize(e.value.size(), NAN);
  newest.std_error.resize(e.value.size(), NAN);
  newest.end_us.resize(e.value.size(), 0);
  for (std::size_t p = 0; p < e.value.size(); ++p) {
    if (e.reason[p] != estimator::Observability::observable) continue;
    newest.value[p] = e.value[p];
    newest.std_error[p] = e.std_error[p];
    newest.end_us[p] = to_microseconds(e.end);
  }
}

TEST(ModeErrors, CoverTheTruthOnceSeparateWindowsHaveShownThem) {
  // GIVEN separate windows of the paper's building with 1 % noise
  const estimator::Structure building = test::table2();
  const Eigen::VectorXd truth = test::table2_theta('c');
  const auto expected =
      natural_modes(building, estimator::ParameterTable(building), {truth, {}}, truth).modes;
  estimator::KanaiTajimi motion;
  motion.duration_s = motion.strong_s = 300;
  int of = 0, frequencies = 0, ratios = 0;
  for (motion.seed = 1; motion.seed <= 2; ++motion.seed) {
    const ExactRecord record = exact_record(
        building, truth, directed(kanai_tajimi(motion), std::numbers::pi / 4), 0.01, 300);
    Config config;
    config.pipeline = {building, record.axes, {}, truth};
    ModeErrors errors(5);
    NewestValues newest;
    std::size_t windows = 0;
    for (const estimator::WindowEstimate& e :
         run_windows(config.pipeline, with_noise(record, motion.seed), 0, 5)) {
      take(e, newest);
      PageModes found = page_modes(config, newest);
      if (!found.why.empty()) continue;
      errors.correct(found);
      if (++windows <= 2 * ModeErrors::kLeastPairs) continue;
      for (std::size_t i = 0; i < found.modes.size(); ++i, ++of) {
        const estimator::NaturalMode& mode = found.modes[i];
        const double off_hz = mode.frequency_hz - expected[i].frequency_hz;
        const double off = mode.damping_ratio - expected[i].damping_ratio;
        frequencies += std::abs(off_hz) < kInterval * mode.frequency_error_hz;
        ratios += std::abs(off) < kInterval * mode.damping_error;
      }
    }
  }
  RecordProperty("frequencies", std::to_string(static_cast<double>(frequencies) / of));
  RecordProperty("ratios", std::to_string(static_cast<double>(ratios) / of));
  ASSERT_GT(of, 500);
  for (const int covered : {frequencies, ratios}) {
    EXPECT_GT(covered, kLeastCoverage * of) << of;
    EXPECT_LT(covered, kMostCoverage * of) << of;
  }
}

}  // namespace page_modes_test
}  // namespace framewatch::daemon
