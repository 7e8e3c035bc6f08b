// SPDX-License-Identifier: MIT
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/config_fixture.h"

namespace framewatch::daemon {
namespace verticals_test {

/// A plane building with a vertical channel at each of these places of the base.
std::string plane_with(const std::vector<std::pair<double, double>>& places,
                       const std::string& more = "") {
  std::string text = R"([structure]
stories = 1
frames_x = ["y1"]
story_height_m = [1.0]
node_mass_kg = 20.0

[[channel]]
name = "base-x"
story = 0
direction = "x"

[[channel]]
name = "F1"
story = 1
frame = "y1"
)";
  int number = 0;
  for (const auto& [x, y] : places)
    text += "\n[[channel]]\nname = \"up" + std::to_string(++number) +
            "\"\nstory = 0\ndirection = \"z\"\nx_m = " + std::to_string(x) +
            "\ny_m = " + std::to_string(y) + "\n" + more;
  return text;
}

TEST(Verticals, AreUsedIfTheyShowHowTheBaseRocks) {
  const Config config = test::good(plane_with({{0, 0}, {10, 0}}));
  ASSERT_EQ(config.pipeline.axes.size(), 4U);
  EXPECT_TRUE(config.pipeline.axes[2].vertical);
  EXPECT_EQ(config.pipeline.axes[3].plan->x_m, 10);
  EXPECT_EQ(config.sources.size(), 4U);
  EXPECT_TRUE(config.unused.empty());
  EXPECT_TRUE(config.pipeline.parameters().grouped());
}

TEST(Verticals, AreReportedAsUnusedIfTheyShowNothing) {
  for (const std::string& text :
       {plane_with({{3, 3}}), plane_with({{0, 0}, {4, 4}}),
        plane_with({{0, 0}, {10, 0}}, "use = false"),
        test::replaced(plane_with({{0, 0}, {10, 0}}), "story = 0\ndirection = \"z\"",
                       "story = 1\ndirection = \"z\""),
        test::replaced(plane_with({{0, 0}, {10, 0}}), "x_m = 10.000000\n", "")}) {
    const Config config = test::good(text);
    EXPECT_EQ(config.pipeline.axes.size(), 2U) << text;
    EXPECT_EQ(config.sources.size(), 2U);
    EXPECT_EQ(config.unused.size(), text.find("up2") == std::string::npos ? 1U : 2U);
    const bool named = text.find("use = false") == std::string::npos;
    for (const UnusedChannel& unused : config.unused) {
      EXPECT_TRUE(!named || unused.reason.find("vertical") != std::string::npos) << unused.reason;
    }
  }
}

TEST(Verticals, AreNotUsedIfFloorPanelsAreIdentified) {
  std::string text = test::kGoodConfig;
  for (const char* at : {"x_m = 0\ny_m = 0", "x_m = 1\ny_m = 0", "x_m = 0\ny_m = 1"})
    text += std::string("[[channel]]\nname = \"up ") + at[6] + at[14] +
            "\"\nstory = 0\ndirection = \"z\"\n" + at + "\n\n";
  const Config config = test::good(text);
  EXPECT_EQ(config.pipeline.axes.size(), 6U);
  ASSERT_EQ(config.unused.size(), 3U);
  EXPECT_NE(config.unused[0].reason.find("floor panels"), std::string::npos);
  EXPECT_FALSE(config.pipeline.parameters().grouped());
}

}  // namespace verticals_test
}  // namespace framewatch::daemon
