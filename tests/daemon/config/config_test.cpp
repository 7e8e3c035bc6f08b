// SPDX-License-Identifier: MIT
#include "daemon/config/config.h"

#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/support/config_fixture.h"
#include "tests/support/paper_buildings.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace config_test {

namespace fs = std::filesystem;

const std::string kConfigs = std::string(FRAMEWATCH_SOURCE_DIR) + "/configs";

Config shipped(const std::string& name) {
  std::vector<ConfigProblem> problems;
  const auto config = load_config(kConfigs + "/" + name, problems);
  EXPECT_TRUE(config) << test::told(problems);
  return config.value_or(Config{});
}

TEST(Config, EveryShippedFileLoads) {
  int loaded = 0;
  for (const auto& entry : fs::directory_iterator(kConfigs)) {
    const std::string name = entry.path().filename();
    if (entry.path().extension() != ".toml" || name.starts_with("scenario_")) continue;
    std::vector<ConfigProblem> problems;
    EXPECT_TRUE(load_config(entry.path(), problems)) << test::told(problems);
    ++loaded;
  }
  EXPECT_GE(loaded, 4);
}

TEST(Config, PaperTablesAreThePapersInThetaOrder) {
  const double kSameNumber = 1e-12;
  const Config t1 = shipped("paper_table1.toml");
  EXPECT_TRUE(t1.pipeline.design.isApprox(test::table1_theta(), kSameNumber));
  EXPECT_EQ(t1.pipeline.structure.node_mass, test::table1().node_mass);
  EXPECT_EQ(t1.pipeline.structure.span_y, test::table1().span_y);
  const Config t2 = shipped("paper_table2.toml");
  EXPECT_TRUE(t2.pipeline.design.isApprox(test::table2_theta('c'), kSameNumber));
  EXPECT_EQ(t2.pipeline.structure.span_x, test::table2().span_x);
  EXPECT_EQ(t2.pipeline.structure.span_y, test::table2().span_y);
}

TEST(Config, MiniShakeTableIsAPlaneBuildingWithoutDesign) {
  const Config c = shipped("mini_shake_table_xsens.toml");
  EXPECT_EQ(c.pipeline.structure.degrees_of_freedom(), 3);
  EXPECT_EQ(c.pipeline.structure.node_mass, std::vector<double>(3, 1.0));
  EXPECT_EQ(c.pipeline.options.rate_hz, 120);
  EXPECT_EQ(c.pipeline.design.size(), 0);
  ASSERT_EQ(c.sources.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    const auto at = static_cast<std::size_t>(i);
    EXPECT_EQ(c.sources[at].sensor_node, i);
    EXPECT_EQ(c.sources[at].axis, 0);
    EXPECT_EQ(c.sources[at].lcm_channel, "ACCEL");
    EXPECT_EQ(c.pipeline.axes[at].story, i);
  }
}

TEST(Config, DigestCoversTheBytes) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("c.toml");
  test::write_file(path, test::kGoodConfig);
  std::vector<ConfigProblem> problems;
  const auto config = load_config(path, problems);
  ASSERT_TRUE(config) << test::told(problems);
  EXPECT_EQ(config->sha256.size(), 64u);
  EXPECT_NE(config->sha256, test::good(std::string(test::kGoodConfig) + "\n").sha256);
  EXPECT_EQ(config->sha256, test::good(test::kGoodConfig).sha256);
}

TEST(Config, PaperVariantHasThePapersHighPassByDefault) {
  const auto options = [](const std::string& estimator) {
    return test::good(std::string(test::kGoodConfig) + "[estimator]\n" + estimator)
        .pipeline.options;
  };
  EXPECT_EQ(options("").high_pass_hz, 0.3);
  EXPECT_EQ(options("variant = \"paper\"\n").high_pass_hz, 0.1);
  EXPECT_EQ(options("variant = \"paper\"\n").variant, estimator::Variant::paper);
  EXPECT_EQ(options("variant = \"paper\"\nhigh_pass_hz = 0.2\n").high_pass_hz, 0.2);
}

TEST(Config, ChannelKeepsItsCalibration) {
  const std::string text = test::replaced(
      test::kGoodConfig, "frame = \"y2\"",
      "frame = \"y2\"\nscale = -2e-3\noffset_mps2 = 0.25\npolarity = -1\ndelay_s = 0.004\n"
      "noise_mps2_per_rthz = 1e-4");
  const Config c = test::good(text);
  const auto axis = std::find_if(c.pipeline.axes.begin(), c.pipeline.axes.end(),
                                 [](const estimator::SensorAxis& a) { return a.name == "F1-Y2"; });
  ASSERT_NE(axis, c.pipeline.axes.end());
  EXPECT_EQ(axis->frame, 1);
  EXPECT_EQ(axis->direction, estimator::Direction::x);
  EXPECT_EQ(axis->scale, -2e-3);
  EXPECT_EQ(axis->offset, 0.25);
  EXPECT_EQ(axis->polarity, -1);
  EXPECT_EQ(axis->delay, 0.004);
  EXPECT_EQ(axis->noise_density, 1e-4);
}

TEST(Config, MassesAreReadStoryThenYThenX) {
  const std::string text = test::replaced(test::kGoodConfig, "node_mass_kg = 20.0",
                                          "node_mass_kg = [[[1, 2], [3, 4.5]]]");
  EXPECT_EQ(test::good(text).pipeline.structure.node_mass, (std::vector<double>{1, 2, 3, 4.5}));
}

TEST(Config, PlaneBuildingTakesMassesAndStiffnessPerStoryAndFrame) {
  const Config c = test::good(R"([structure]
stories = 2
frames_x = ["a", "b"]
span_y_m = 3
story_height_m = 3
node_mass_kg = [[1, 2], [3, 4]]
[structure.design]
kx_npm = [[10, 20], [30, 40]]
[[channel]]
name = "g"
story = 0
direction = "x"
[[channel]]
name = "1a"
story = 1
frame = "a"
[[channel]]
name = "1b"
story = 1
frame = "b"
[[channel]]
name = "2a"
story = 2
frame = "a"
[[channel]]
name = "2b"
story = 2
frame = "b"
)");
  const estimator::Structure& s = c.pipeline.structure;
  EXPECT_EQ(s.frame_mass(1, 1), 2);
  EXPECT_EQ(s.frame_mass(2, 0), 3);
  EXPECT_EQ(c.pipeline.design[estimator::ParameterTable(s).frame_stiffness(2, 1)], 40);
  EXPECT_LT(c.sources[0].sensor_node, 0);
}

TEST(Config, PanelsWithoutDesignAreAsStiffAsTheMeanFrameOfTheirStory) {
  const Config c = test::good(std::string(test::kGoodConfig) +
                              "[structure.design]\nkx_npm = [[1e4, 2e4]]\nky_npm = 3e4\n");
  const estimator::ParameterTable table(c.pipeline.structure);
  EXPECT_DOUBLE_EQ(c.pipeline.design[table.panel_stiffness(1, 0)], 2.25e4);
}

TEST(Config, DesignDampingHasTheRatioAtTheFirstMode) {
  const Config c = shipped("table_two_story.toml");
  const estimator::Structure& s = c.pipeline.structure;
  const estimator::ParameterTable table(s);
  const double w1 = 2 * M_PI * natural_frequencies_hz(s, table, c.pipeline.design).front();
  for (int i = 0; i < table.elements(); ++i)
    EXPECT_NEAR(c.pipeline.design[i + table.elements()] * w1 / 2 / c.pipeline.design[i], 0.01,
                1e-12);
}

}  // namespace config_test
}  // namespace framewatch::daemon
