// SPDX-License-Identifier: MIT
#include "daemon/page/view/page_modes.h"

#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/page/view/page_json.h"
#include "daemon/tools/lab/accuracy_trial.h"
#include "estimator/identify/elements/story_design.h"
#include "tests/support/config_fixture.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::daemon {
namespace page_modes_test {

constexpr double kLeastCoverage = 0.90, kMostCoverage = 0.999;  // of intervals of 95 %
constexpr double kStep = 1e-4;                                  // relative
constexpr double kSlopeError = 1e-3;                            // relative

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
  const auto expected = natural_modes(
      config.pipeline.structure, config.pipeline.parameters(),
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
  double known = 0, guessed = 0;
  for (const auto& mode : page_modes(config, all).modes) known += mode.frequency_error_hz;
  for (const auto& mode : of_design.modes) guessed += mode.frequency_error_hz;
  EXPECT_GT(guessed, 1.5 * known);
  // A frame's damping is the reason why there is no damping.
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

TEST(PageModes, ErrorsCoverTheTruth) {
  // GIVEN separate windows of the paper's building with 1 % noise
  AccuracyTrial trial;
  trial.structure = test::table2();
  trial.truth = trial.design = test::table2_theta();
  trial.duration_s = 60;
  trial.noise_ratio = 0.01;
  trial.every_s = 5;
  const auto expected = natural_modes(trial.structure, estimator::ParameterTable(trial.structure),
                                      {trial.truth, {}}, trial.truth);
  Config config;
  config.pipeline.structure = trial.structure;
  config.pipeline.design = trial.design;
  int of = 0, frequencies = 0, ratios = 0;
  for (trial.seed = 1; trial.seed <= 4; ++trial.seed) {
    trial.motion = oblique_motion(trial.seed);
    for (const estimator::WindowEstimate& e : run_trial(trial)) {
      const PageModes found = page_modes(
          config, {e.value, e.std_error, std::vector<std::int64_t>(e.value.size(), 1)});
      for (std::size_t i = 0; i < found.modes.size(); ++i, ++of) {
        const estimator::NaturalMode& is = found.modes[i];
        const estimator::NaturalMode& truth = expected.modes[i];
        frequencies +=
            std::abs(is.frequency_hz - truth.frequency_hz) < 1.96 * is.frequency_error_hz;
        ratios += std::abs(is.damping_ratio - truth.damping_ratio) < 1.96 * is.damping_error;
      }
    }
  }
  ASSERT_GT(of, 100);
  for (const int covered : {frequencies, ratios}) {
    EXPECT_GT(covered, kLeastCoverage * of) << of;
    EXPECT_LT(covered, kMostCoverage * of) << of;
  }
}

}  // namespace page_modes_test
}  // namespace framewatch::daemon
