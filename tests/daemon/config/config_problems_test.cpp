// SPDX-License-Identifier: MIT
#include <ostream>
#include <utility>

#include <gtest/gtest.h>

#include "daemon/config/config.h"
#include "tests/support/config_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace config_problems_test {

/// kGoodConfig with one text replaced, and all problems that this causes.
struct Malformed {
  const char* name;
  const char* what;
  const char* by;
  std::vector<std::pair<std::string, std::string>> expected;  ///< line:column, part of the message
};

std::ostream& operator<<(std::ostream& out, const Malformed& malformed) {
  return out << malformed.name;
}

class ConfigProblems : public testing::TestWithParam<Malformed> {};

TEST_P(ConfigProblems, AreAllReportedAtTheirPlaces) {
  const Malformed& m = GetParam();
  std::vector<ConfigProblem> problems;
  const std::string text = test::replaced(test::kGoodConfig, m.what, m.by);
  EXPECT_FALSE(parse_config("c.toml", text, problems));
  ASSERT_EQ(problems.size(), m.expected.size()) << test::told(problems);
  for (std::size_t i = 0; i < problems.size(); ++i) {
    EXPECT_EQ(problems[i].where, "c.toml:" + m.expected[i].first) << problems[i].message;
    EXPECT_NE(problems[i].message.find(m.expected[i].second), std::string::npos)
        << problems[i].message;
  }
}

const Malformed kMalformed[] = {
    {"Syntax", "stories = 1", "stories = ", {{"2:11", "nothing stands after the ="}}},
    {"DuplicateKey",
     "stories = 1",
     "stories = 1\nstories = 2",
     {{"3:1", "duplicate: cannot redefine existing integer 'stories'"}}},
    {"DuplicateHidesNothing",
     "stories = 1",
     "stories = 1\nstories = 2\nname = 7",
     {{"3:1", "duplicate"}, {"4:8", "structure.name: expected a text in quotes, got 7"}}},
    {"DuplicateSection",
     "[[channel]]",
     "[structure]\nname = \"again\"\n[[channel]]",
     {{"10:1", "duplicate: the section [structure] was there before"}}},
    {"UnknownSection",
     "[[channel]]",
     "[estimater]\nwindow_s = 5\n[[channel]]",
     {{"10:2", "unknown section or key estimater: did you mean estimator?"}}},
    {"UnknownKey",
     "stories = 1",
     "stories = 1\nfloors = \"rigid\"",
     {{"3:1", "structure: unknown key floors: did you mean floor?"}}},
    {"KeyOfAnotherSection",
     "stories = 1",
     "stories = 1\nrate_hz = 50",
     {{"3:1", "structure: unknown key rate_hz: it is a key of [estimator]"}}},
    {"WrongUnit",
     "node_mass_kg = 20.0",
     "node_mass_t = 0.02",
     {{"1:1", "structure.node_mass_kg: is missing"},
      {"8:1", "structure: unknown key node_mass_t: the unit is kg: write node_mass_kg"}}},
    {"NumberWithUnit",
     "node_mass_kg = 20.0",
     "node_mass_kg = \"20 kg\"",
     {{"8:16", "expected a number (kg) or [story][y][x], got the text \"20 kg\""}}},
    {"WrongType",
     "stories = 1",
     "stories = 1.0",
     {{"2:11", "structure.stories: expected a whole number, got 1"}}},
    {"OutOfRange",
     "stories = 1",
     "stories = 0",
     {{"2:11", "structure.stories: must be >= 1 and <= 1000, got 0"}}},
    {"NotFinite",
     "node_mass_kg = 20.0",
     "node_mass_kg = nan",
     {{"8:16", "structure.node_mass_kg: must be > 0 and <= 1000000000 kg, got nan"}}},
    {"NegativeMassInTheMiddle",
     "node_mass_kg = 20.0",
     "node_mass_kg = [[[1, 2], [-3, 4]]]",
     {{"8:27", "structure.node_mass_kg: must be > 0"}}},
    {"MassMatrixOfTheWrongShape",
     "node_mass_kg = 20.0",
     "node_mass_kg = [[[1, 2], [3, 4, 5]]]",
     {{"8:26", "[story][y][x] is 1 x 2 x 2: here a list of 2 is expected, found 3"}}},
    {"MassMatrixWithoutNesting",
     "node_mass_kg = 20.0",
     "node_mass_kg = [1, 2, 3, 4]",
     {{"8:16", "structure.node_mass_kg: [story][y][x] is 1 x 2 x 2"}}},
    {"SpanMissing",
     "span_x_m = [1.0]\n",
     "",
     {{"1:1", "structure.span_x_m: [x span] is 1: here a list of 1 is expected, found 0"}}},
    {"UnknownChoice",
     "node_mass_kg",
     "floor = \"ridgid\"\nnode_mass_kg",
     {{"8:9", "must be one of \"flexible\", \"rigid\", got \"ridgid\", did you mean \"rigid\"?"}}},
    {"FrameNamedTwice",
     "frames_y = [\"x1\", \"x2\"]",
     "frames_y = [\"x1\", \"y1\"]",
     {{"4:12", "structure.frames_y: 'y1' is the name of two frames"}}},
    {"FrameNameWithComma",
     "frames_y = [\"x1\", \"x2\"]",
     "frames_y = [\"x1\", \"x,2\"]",
     {{"4:12", "must not hold a comma"}}},
    {"ChannelOnAFrameThatDoesNotExist",
     "frame = \"y2\"",
     "frame = \"y9\"",
     {{"29:9", "channel 'F1-Y2'.frame: no frame is named \"y9\""}}},
    {"ChannelOnAStoryThatDoesNotExist",
     "story = 1\nframe = \"y2\"",
     "story = 2\nframe = \"y2\"",
     {{"28:9", "channel 'F1-Y2'.story: story 2 does not exist, 0 (base) to 1 do"}}},
    {"TwoChannelsInOnePlace",
     "frame = \"y2\"",
     "frame = \"y1\"",
     {{"26:1", "channel 'F1-Y2': is at the same place as channel 'F1-Y1'"}}},
    {"TwoChannelsOfOneName",
     "\"F1-Y2\"",
     "\"F1-Y1\"",
     {{"27:8", "channel 'F1-Y1'.name: another channel has this name already"}}},
    {"TwoChannelsOfOneSource",
     "frame = \"y2\"",
     "frame = \"y2\"\nsource = { lcm = \"ACCEL\", node = 2, axis = \"x\" }",
     {{"30:10", "axis x of node 2 on ACCEL is the source of channel 'F1-Y1' already"}}},
    {"NoBaseDirection",
     "story = 0\ndirection = \"y\"",
     "story = 0\ndirection = \"x\"",
     {{"10:3", "channels: no base channel (story = 0) in direction y"},
      {"15:1", "channel 'base-y': is at the same place as channel 'base-x'"}}},
    {"BaseChannelWithoutDirection",
     "direction = \"y\"",
     "",
     {{"10:3", "channels: no base channel (story = 0) in direction y"},
      {"15:1", "channel 'base-y'.direction: is missing"}}},
    {"DirectionAcrossTheFrame",
     "frame = \"y2\"",
     "frame = \"y2\"\ndirection = \"y\"",
     {{"30:13", "channel 'F1-Y2'.direction: frame y2 moves along x"}}},
    {"ChannelTable",
     "[[channel]]\nname = \"F1-X2\"",
     "[[chanel]]\nname = \"F1-X2\"",
     {{"36:3", "unknown section or key chanel: did you mean channel?"}}},
    {"ScaleOfZero",
     "frame = \"y2\"",
     "frame = \"y2\"\nscale = 0",
     {{"30:9", "channel 'F1-Y2'.scale: scale must not be 0"}}},
    {"PolarityOfZero",
     "frame = \"y2\"",
     "frame = \"y2\"\npolarity = 0",
     {{"30:12", "channel 'F1-Y2'.polarity: polarity must be 1 or -1"}}},
    {"CanSource",
     "source = { lcm = \"ACCEL\", node = 2, axis = \"x\" }",
     "source = { can = \"can0\", dbc_signal = \"Node3.AccX\" }",
     {{"24:1", "channel 'F1-Y1'.source: can: no [[can]] has interface = \"can0\""}}},
    {"SourceWithoutNode", "node = 2, ", "", {{"24:10", "channel 'F1-Y1'.source.node: is missing"}}},
    {"SourceAxis",
     "axis = \"x\"",
     "axis = \"w\"",
     {{"24:44", "channel 'F1-Y1'.source.axis: must be one of \"x\", \"y\", \"z\", got \"w\""}}},
    {"HighPassAboveNyquist",
     "[[channel]]",
     "[estimator]\nrate_hz = 10\nwindow_s = 10\nhigh_pass_hz = 6\n[[channel]]",
     {{"13:16", "estimator.high_pass_hz: must be below half the sampling rate, 5 Hz"}}},
    {"WindowOfFewSamples",
     "[[channel]]",
     "[estimator]\nwindow_s = 0.2\n[[channel]]",
     {{"11:12", "estimator.window_s: must hold at least 40 samples: >= 0.4 s at 100 Hz"}}},
    {"HopLongerThanWindow",
     "[[channel]]",
     "[estimator]\nhop_s = 6\n[[channel]]",
     {{"11:9", "estimator.hop_s: must not be longer than the window, 5 s"}}},
    {"SectionIsAValue",
     "[[channel]]",
     "[lcm]\nurl = 7\nprefix = true\n[[channel]]",
     {{"11:7", "lcm.url: expected a text in quotes, got 7"},
      {"12:10", "lcm.prefix: expected a text in quotes, got true"}}},
    {"UrlWithoutProvider",
     "[[channel]]",
     "[lcm]\nurl = \"239.255.76.67\"\n[[channel]]",
     {{"11:7", "lcm.url: expected a provider such as udpm://"}}},
    {"DesignIncomplete",
     "[[channel]]",
     "[structure.design]\nkx_npm = 1e4\n[[channel]]",
     {{"10:1",
       "structure.design.ky_npm: is missing: a design needs the stiffness of every frame"}}},
    {"DesignOfTheWrongShape",
     "[[channel]]",
     "[structure.design]\nkx_npm = [[1e4, 1e4, 1e4]]\nky_npm = 1e4\n[[channel]]",
     {{"11:11", "structure.design.kx_npm: [story][frame] is 1 x 2: here a list of 2"}}},
    {"ManyAtOnce",
     "stories = 1\n",
     "stories = 1\nnmae = \"a\"\nfloor = 3\n",
     {{"3:1", "unknown key nmae: did you mean name?"},
      {"4:9", "structure.floor: expected one of"}}},
};

INSTANTIATE_TEST_SUITE_P(Malformed, ConfigProblems, testing::ValuesIn(kMalformed),
                         [](const auto& test_case) { return std::string(test_case.param.name); });

TEST(ConfigFile, AMissingFileOrADirectoryIsAProblemOfTheFile) {
  const test::TemporaryDirectory directory;
  std::vector<ConfigProblem> problems;
  EXPECT_FALSE(load_config(directory.path("no.toml"), problems));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].where, directory.path("no.toml"));
  EXPECT_NE(problems[0].message.find("No such file"), std::string::npos) << problems[0].message;
  EXPECT_FALSE(load_config(directory.path("."), problems));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].message, "is a directory, not a file");
}

TEST(ConfigFile, EmptyTextReportsMissingKeys) {
  std::vector<ConfigProblem> problems;
  EXPECT_FALSE(parse_config("c.toml", "", problems));
  const std::string all = test::told(problems);
  for (const char* key : {"stories", "story_height_m", "node_mass_kg"})
    EXPECT_NE(all.find(std::string("structure.") + key + ": is missing"), std::string::npos) << all;
}

}  // namespace config_problems_test
}  // namespace framewatch::daemon
