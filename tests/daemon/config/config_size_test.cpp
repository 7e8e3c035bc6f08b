// SPDX-License-Identifier: MIT
#include "daemon/config/config_size.h"

#include <chrono>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/config/config.h"
#include "tests/support/config_fixture.h"

namespace framewatch::daemon {
namespace config_size_test {

// Limits.
constexpr std::chrono::seconds kToRefuse{20};  // for a debug build on a busy machine

/// Returns a tower of `bays` x `bays` with a sensor on every frame of every floor.
std::string tower(int stories, int bays, const std::string& estimator) {
  std::string x, y;
  for (int f = 0; f <= bays; ++f) {
    x += fmt::format("{}\"y{}\"", f == 0 ? "" : ", ", f);
    y += fmt::format("{}\"x{}\"", f == 0 ? "" : ", ", f);
  }
  std::string out = fmt::format(
      "[structure]\nstories = {}\nframes_x = [{}]\nframes_y = [{}]\nspan_x_m = 5.0\n"
      "span_y_m = 5.0\nstory_height_m = 3.0\nnode_mass_kg = 1000.0\n[estimator]\n{}"
      "[[channel]]\nname = \"bx\"\nstory = 0\ndirection = \"x\"\n"
      "[[channel]]\nname = \"by\"\nstory = 0\ndirection = \"y\"\n",
      stories, x, y, estimator);
  for (int story = 1; story <= stories; ++story)
    for (int f = 0; f <= bays; ++f)
      for (const char axis : {'x', 'y'})
        out += fmt::format("[[channel]]\nname = \"F{0}{1}{2}\"\nstory = {0}\nframe = \"{1}{2}\"\n",
                           story, axis, f);
  return out;
}

struct TooLarge {
  const char* name;
  std::string text;
  std::string line, part;
};

TEST(ConfigSize, RefusesTooLargeValuesWithTheirLineBeforeAllocating) {
  const TooLarge kTooLarge[] = {
      {"stories", tower(1000, 3, ""), "2:11", "structure.stories: the estimation would take"},
      {"window", tower(2, 1, "rate_hz = 100000\nwindow_s = 3600\nboxplot_windows = 100000\n"),
       "11:12", "estimator.window_s: the estimation would take"},
      {"high pass",
       tower(2, 1,
             "rate_hz = 100000\nhigh_pass_hz = 0.001\nwindow_s = 0.05\n"
             "other_windows_s = [0.1]\n"),
       "11:16", "estimator.high_pass_hz"},
      {"boxplots", tower(60, 3, "boxplot_windows = 100000\n"), "10:19",
       "estimator.boxplot_windows"},
      {"lateness",
       tower(100, 1,
             "rate_hz = 20000\nlateness_s = 60\nhigh_pass_hz = 10\n"
             "window_s = 0.05\nother_windows_s = [0.1]\nsettle_s = 0.1\n"),
       "11:14", "estimator.lateness_s"},
      {"segments",
       tower(2, 1, "rate_hz = 1000\n") + "[gap]\nmodel = \"m\"\nstore = \"s\"\nlasting_s = 86400\n",
       "", "gap.lasting_s"},
  };
  for (const TooLarge& t : kTooLarge) {
    const auto began = std::chrono::steady_clock::now();
    std::vector<ConfigProblem> problems;
    EXPECT_FALSE(parse_config("c.toml", t.text, problems)) << t.name;
    EXPECT_LT(std::chrono::steady_clock::now() - began, kToRefuse) << t.name;
    ASSERT_EQ(problems.size(), 1u) << t.name << test::told(problems);
    EXPECT_TRUE(problems[0].where.starts_with("c.toml:" + t.line)) << test::told(problems);
    for (const std::string& part :
         {t.part, std::string("GiB of memory"), std::string("at most 1.25 GiB is allowed")})
      EXPECT_NE(problems[0].message.find(part), std::string::npos) << test::told(problems);
  }
}

TEST(ConfigSize, DisablesTheGapForABuildingTooLargeToSimulate) {
  std::vector<ConfigProblem> problems;
  EXPECT_FALSE(parse_config("c.toml", tower(100, 3, "") + "[gap]\nmodel = \"m\"\n", problems));
  ASSERT_EQ(problems.size(), 1u) << test::told(problems);
  EXPECT_NE(problems[0].message.find("gap: 100 stories of 8 frames have 800 degrees of freedom"),
            std::string::npos)
      << test::told(problems);
}

TEST(ConfigSize, AcceptsEveryBuildingOfThePerformanceTable) {
  std::vector<ConfigProblem> problems;
  EXPECT_TRUE(parse_config("c.toml", tower(300, 3, ""), problems)) << test::told(problems);
  EXPECT_TRUE(parse_config("c.toml", tower(60, 1, "rate_hz = 1000\n"), problems))
      << test::told(problems);
}

}  // namespace config_size_test
}  // namespace framewatch::daemon
