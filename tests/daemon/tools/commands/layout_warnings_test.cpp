// SPDX-License-Identifier: MIT
#include "daemon/tools/commands/layout_warnings.h"

#include <cmath>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/tools/commands/check_report.h"
#include "tests/support/config_fixture.h"

namespace framewatch::daemon {
namespace layout_warnings_test {

/// Ten rigid floors, one frame along x and two along y; channels as given.
std::string building(const std::string& channels) {
  return "[structure]\nname = \"ten\"\nstories = 10\nframes_x = [\"y1\"]\n"
         "frames_y = [\"x1\", \"x2\"]\nspan_x_m = [20.0]\nstory_height_m = 3.5\n"
         "floor = \"rigid\"\nnode_mass_kg = 400e3\nazimuth_y_deg = 0\n"
         "[structure.design]\nkx_npm = 2e9\nky_npm = 1e9\ndamping_ratio = 0.02\n"
         "[estimator]\nrate_hz = 100\n" +
         channels;
}

std::string channel(const std::string& name, int story, const std::string& place) {
  return "[[channel]]\nname = \"" + name + "\"\nstory = " + std::to_string(story) + "\n" + place +
         "\nnoise_mps2_per_rthz = 1e-4\n";
}

std::string level(int story) {
  const std::string n = std::to_string(story);
  return channel("x" + n, story, "azimuth_deg = 90") +
         channel("l" + n, story, "azimuth_deg = 0\nx_m = 0") +
         channel("r" + n, story, "azimuth_deg = 0\nx_m = 20");
}

CheckReport checked(const std::string& channels, int advise = 0) {
  return make_check_report(test::good(building(channels)), advise);
}

bool warns(const CheckReport& report, const std::string& part) {
  for (const std::string& warning : report.warnings)
    if (warning.find(part) != std::string::npos) return true;
  return false;
}

std::string all_of(const CheckReport& report) {
  std::string out;
  for (const std::string& warning : report.warnings) out += warning + "\n";
  return out;
}

TEST(LayoutWarnings, AreAbsentForAGoodLayout) {
  const CheckReport r = checked(level(0) + level(5) + level(10));
  ASSERT_TRUE(r.layout);
  EXPECT_EQ(all_of(r).find("channel"), std::string::npos) << all_of(r);
  EXPECT_EQ(all_of(r).find("roof"), std::string::npos) << all_of(r);
}

TEST(LayoutWarnings, NameTallOrSlenderFramesThatDoNotBend) {
  const std::string channels = level(0) + level(5) + level(10);
  const auto warned = [&](const std::string& what, const std::string& by, const char* direction) {
    const CheckReport r =
        make_check_report(test::good(test::replaced(building(channels), what, by)), 0);
    return warns(r, std::string("frames parallel to ") + direction + " of");
  };
  EXPECT_TRUE(warned("name", "name", "x"));
  EXPECT_TRUE(warned("name", "name", "y"));
  EXPECT_FALSE(warned("[structure.design]", "[structure.design]\nkrx_nmprad = 3e12", "x"));
  EXPECT_TRUE(warned("[structure.design]", "[structure.design]\nkrx_nmprad = 3e12", "y"));
  // Nine stories of 3.5 m: judged by their shape along x, the only direction with a known width.
  const std::string lower = test::replaced(
      test::replaced(building(level(0) + level(9)), "stories = 10", "stories = 9"), "20.0", "8.0");
  const CheckReport r =
      make_check_report(test::good(test::replaced(test::replaced(lower, "x_m = 20", "x_m = 8"),
                                                  "x_m = 20", "x_m = 8")),
                        0);
  EXPECT_TRUE(warns(r, "frames parallel to x of 9 stories, 31.5 m high and 8 m wide")) << all_of(r);
  EXPECT_FALSE(warns(r, "frames parallel to y of"));
}

TEST(LayoutWarnings, NameADirectionThatNoChannelMeasures) {
  const std::string x = "azimuth_deg = 90";
  const CheckReport r = checked(channel("b", 0, x) + channel("m", 5, x) + channel("t", 10, x));
  EXPECT_TRUE(warns(r, "no channel above the base measures along y")) << all_of(r);
  EXPECT_FALSE(warns(r, "measures along x"));
}

TEST(LayoutWarnings, NameAGroupThatNoiseHides) {
  std::string noisy = level(0) + level(5) + level(10);
  for (std::size_t at = 0; (at = noisy.find("1e-4", at)) != std::string::npos;)
    noisy.replace(at, 4, "0.30");
  EXPECT_TRUE(warns(checked(noisy), "no value will be shown"));
}

TEST(LayoutWarnings, NameARoofWithoutAChannel) {
  const CheckReport r = checked(level(0) + level(4) + level(7));
  EXPECT_TRUE(warns(r, "no channel on the roof, floor 10")) << all_of(r);
  // The errors are those that check predicts for this building and for one with the channel.
  ASSERT_TRUE(r.layout && r.layout->top);
  const CheckReport with = checked(level(0) + level(4) + level(7) + level(10));
  ASSERT_TRUE(with.layout);
  EXPECT_FALSE(with.layout->top);
  EXPECT_FALSE(warns(with, "roof")) << all_of(with);
  double worst = 0;
  for (const GroupOutlook& g : with.layout->groups)
    if (g.parameter.find("to10") != std::string::npos)
      worst = std::max(worst, std::hypot(g.window_error, g.design_error, g.sensor_error));
  EXPECT_GT(worst, 0);
  EXPECT_DOUBLE_EQ(r.layout->top_with_roof.stiffness, worst);
  EXPECT_TRUE(warns(r, fmt::format("with a channel on the roof, {:.2g} % and ", 100 * worst)))
      << all_of(r);
}

TEST(LayoutWarnings, NameOnlyGroupsWhoseErrorIsLarge) {
  // A single story below the roof of ten is predicted to 3 %, of forty only to 30 %.
  const std::string ten = building(level(0) + level(1) + level(5) + level(9) + level(10));
  const CheckReport low = make_check_report(test::good(ten), 0);
  EXPECT_FALSE(warns(low, "_10")) << all_of(low);
  const std::string forty = test::replaced(building(level(0) + level(10) + level(39) + level(40)),
                                           "stories = 10", "stories = 40");
  const CheckReport high = make_check_report(test::good(forty), 0);
  EXPECT_TRUE(warns(high, "kx_40_y1: the design's tolerances will put its value off by"))
      << all_of(high);
  EXPECT_FALSE(warns(high, "39")) << all_of(high);
  const auto at_limit = [&](const char* limit) {
    return make_check_report(
        test::good(test::replaced(forty, "[estimator]",
                                  std::string("[estimator]\nmax_error_k_ratio = ") + limit)),
        0);
  };
  EXPECT_TRUE(warns(at_limit("0.05"), "kx_40_y1: errors of gain and time will put its value off"));
  EXPECT_FALSE(warns(at_limit("0.5"), "kx_40_y1"));
}

TEST(LayoutWarnings, AreAbsentForALaboratoryTable) {
  std::string table = level(0) + level(1) + level(2) + level(3);
  for (std::size_t at = 0; (at = table.find("x_m = 20", at)) != std::string::npos;)
    table.replace(at, 8, "x_m = 0.5");
  table = building(table);
  for (const auto& [what, by] :
       {std::pair{"stories = 10", "stories = 3"}, std::pair{"[20.0]", "[0.5]"},
        std::pair{"= 3.5", "= 0.3"}, std::pair{"400e3", "2.5"}, std::pair{"2e9", "9e3"},
        std::pair{"1e9", "9e3"}})
    table = test::replaced(table, what, by);
  const CheckReport r = make_check_report(test::good(table), 0);
  ASSERT_TRUE(r.layout);
  EXPECT_EQ(all_of(r), "");
  for (const GroupOutlook& g : r.layout->groups) {
    EXPECT_LT(g.window_error, 0.001) << g.parameter;
    EXPECT_GT(g.sensor_error, 0.001) << g.parameter;
    EXPECT_LT(g.sensor_error, 0.02) << g.parameter;
  }
}

TEST(LayoutWarnings, NameTwoChannelsThatMeasureTheSameMotion) {
  const std::string base = level(0) + level(10);
  EXPECT_TRUE(warns(
      checked(base + channel("e", 5, "azimuth_deg = 90") + channel("w", 5, "azimuth_deg = 270")),
      "'e' and 'w' measure the same motion of floor 5 with opposite signs"));
  EXPECT_TRUE(warns(
      checked(base + channel("e", 5, "azimuth_deg = 90") + channel("f", 5, "azimuth_deg = 90")),
      "'e' and 'f' measure the same motion of floor 5: their mean"));
  EXPECT_FALSE(warns(checked(base + level(5)), "the same motion"));
}

TEST(LayoutWarnings, NameAzimuthsOffTheFrames) {
  const CheckReport r =
      checked(level(0) + level(10) + channel("s", 5, "azimuth_deg = 60\ny_m = 1"));
  EXPECT_TRUE(warns(r, "'s' points 30 degrees off the frames of direction x")) << all_of(r);
  EXPECT_FALSE(warns(checked(level(0) + level(5) + level(10)), "degrees off"));
}

TEST(LayoutWarnings, TextAndJsonHaveAdvice) {
  const CheckReport r = checked(level(0) + level(5) + level(10), 2);
  ASSERT_EQ(r.layout->advised.size(), 2u);
  EXPECT_LE(r.layout->advised[0].least_seen_loss, r.layout->advised[1].least_seen_loss);
  EXPECT_LT(r.layout->advised[0].least_seen_loss, r.layout->least_seen_loss);
  EXPECT_NE(to_text(r).find("advice      with channels on floor"), std::string::npos);
  const auto json = nlohmann::json::parse(to_json("c.toml", r, {}));
  ASSERT_EQ(json["layout"]["advice"].size(), 2u);
  EXPECT_EQ(json["layout"]["advice"][0]["floor"], r.layout->advised[0].floor);
  EXPECT_EQ(json["layout"]["measured_floors"], nlohmann::json({5, 10}));
  EXPECT_TRUE(checked(level(0) + level(5) + level(10)).layout->advised.empty());
}

}  // namespace layout_warnings_test
}  // namespace framewatch::daemon
