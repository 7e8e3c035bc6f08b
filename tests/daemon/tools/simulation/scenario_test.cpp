// SPDX-License-Identifier: MIT
#include "daemon/tools/simulation/scenario.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/structure/parameter_table.h"
#include "tests/support/data.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace scenario_test {

/// One story, 1x1 bay, with its sensors.
const std::string kBuilding = R"(
[structure]
stories = 1
frames_x = ["y1", "y2"]
frames_y = ["x1", "x2"]
span_x_m = [2.0]
span_y_m = [1.0]
story_height_m = [1.0]
node_mass_kg = 20.0

[structure.design]
kx_npm = [[20e3, 30e3]]
ky_npm = [[25e3, 25e3]]
gk = [[[8e3]]]
damping_ratio = 0.01

[[channel]]
name = "F1-Y1"
story = 1
frame = "y1"
[[channel]]
name = "F1-Y2"
story = 1
frame = "y2"
[[channel]]
name = "F1-X1"
story = 1
frame = "x1"
[[channel]]
name = "F1-X2"
story = 1
frame = "x2"
[[channel]]
name = "F0-X"
story = 0
direction = "x"
[[channel]]
name = "F0-Y"
story = 0
direction = "y"
)";

struct Reading {
  std::optional<Scenario> scenario;
  std::vector<ConfigProblem> problems;

  std::string all() const {
    std::string out;
    for (const ConfigProblem& p : problems) out += p.where + ": " + p.message + "\n";
    return out;
  }
  bool says(const std::string& where, const std::string& what) const {
    return std::any_of(problems.begin(), problems.end(), [&](const ConfigProblem& p) {
      return p.where.find(where) != std::string::npos && p.message.find(what) != std::string::npos;
    });
  }
};

Reading read(const std::string& top, const std::string& sections) {
  Reading out;
  out.scenario = read_scenario(top + kBuilding + sections, "s.toml", out.problems);
  return out;
}

double parameter(const Scenario& s, const Eigen::VectorXd& theta, const std::string& name) {
  return theta[estimator::ParameterTable(s.config.pipeline.structure).find(name).value()];
}

TEST(Scenario, DefaultsRun) {
  const Reading r = read("", "");
  ASSERT_TRUE(r.scenario) << r.all();
  EXPECT_EQ(r.scenario->truth, r.scenario->config.pipeline.design);
  EXPECT_EQ(r.scenario->rate_hz, 100);
  EXPECT_DOUBLE_EQ(r.scenario->duration_s, 30);
  EXPECT_NEAR(std::hypot(r.scenario->motion.x.peak(), r.scenario->motion.y.peak()), 2, 1e-9);
}

TEST(Scenario, TruthOverridesTheDesign) {
  const Reading r = read("", "[truth]\nkx_npm = [[22e3, 27e3]]\ngc = [[[12.5]]]\n");
  ASSERT_TRUE(r.scenario) << r.all();
  const Scenario& s = *r.scenario;
  EXPECT_EQ(parameter(s, s.truth, "kx_1_y2"), 27e3);
  EXPECT_EQ(parameter(s, s.truth, "ky_1_x1"), 25e3);
  EXPECT_EQ(parameter(s, s.truth, "Gc_1_x1y1"), 12.5);
  const double ratio = parameter(s, s.truth, "cx_1_y1") / 22e3;
  EXPECT_NEAR(parameter(s, s.truth, "cy_1_x1") / 25e3, ratio, 1e-15);
  EXPECT_GT(ratio, 0);
}

TEST(Scenario, ChangesMultiplyInOrderOfTime) {
  const Reading r = read("", R"(
[[change]]
at_s = 20
parameter = "kx_1_y1"
factor = 0.5
[[change]]
at_s = 10
parameter = "kx_1_y1"
factor = 0.9
)");
  ASSERT_TRUE(r.scenario) << r.all();
  ASSERT_EQ(r.scenario->changes.size(), 2u);
  EXPECT_EQ(r.scenario->changes[0].at_s, 10);
  EXPECT_DOUBLE_EQ(parameter(*r.scenario, r.scenario->changes[0].theta, "kx_1_y1"), 18e3);
  EXPECT_DOUBLE_EQ(parameter(*r.scenario, r.scenario->changes[1].theta, "kx_1_y1"), 9e3);
}

TEST(Scenario, OneSensorMayDiffer) {
  const Reading r = read("seed = 4\n", R"(
[sensors]
noise_mps2_per_rthz = 1e-4
full_scale_g = 2
bits = 16
[[sensor]]
channel = "F1-X1"
bias_mps2 = 0.05
noise_ratio = 0.01
dead_from_s = 12
)");
  ASSERT_TRUE(r.scenario) << r.all();
  const Scenario& s = *r.scenario;
  EXPECT_EQ(s.seed, 4u);
  EXPECT_EQ(s.sensors[0].bias, 0);
  EXPECT_EQ(s.sensors[2].bias, 0.05);
  EXPECT_EQ(s.sensors[2].bits, 16);
  EXPECT_NEAR(s.sensors[2].full_scale, 19.6133, 1e-9);
  EXPECT_EQ(s.noise_ratio[2], 0.01);
  EXPECT_EQ(s.noise_ratio[1], 0);
  EXPECT_EQ(s.sensors[2].dead_from_s, 12);
}

TEST(Scenario, NoiseRatioRefersToTheChannelsRms) {
  Reading noisy = read("duration_s = 20\n", "[sensors]\nnoise_ratio = 0.1\n");
  Reading clean = read("duration_s = 20\n", "");
  ASSERT_TRUE(noisy.scenario && clean.scenario) << noisy.all();
  Simulation a(*noisy.scenario), b(*clean.scenario);
  double noise = 0, signal = 0;
  for (int i = 0; i < 2001; ++i) {
    const double with = a.next()[1];
    const double without = b.next()[1];
    noise += (with - without) * (with - without);
    signal += without * without;
  }
  EXPECT_NEAR(std::sqrt(noise / signal), 0.1, 0.007);
}

TEST(Scenario, ReadsARecordedMotion) {
  FRAMEWATCH_DATA_OR_SKIP(path, "ground_motions/hachi.txt");
  const Reading r = read("", "[motion]\nfile = \"" + path +
                                 "\"\nunit = \"gal\"\nstep_s = 0.01\nangle_deg = 0\nstart_s = 2\n");
  ASSERT_TRUE(r.scenario) << r.all();
  EXPECT_NEAR(r.scenario->motion.x.peak(), 2.2477, 1e-4);
  EXPECT_NEAR(r.scenario->motion.x.at(2 + 4.18), r.scenario->motion.x.at(6.18), 1e-12);
  EXPECT_NEAR(std::abs(r.scenario->motion.x.at(2 + 4.18)), 2.2477, 1e-4);
  EXPECT_EQ(r.scenario->motion.x.at(1.0), 0);
  EXPECT_NEAR(r.scenario->duration_s, 38, 1e-9);
}

TEST(Scenario, ReportsEveryProblemWithItsPlace) {
  const Reading r = read("sed = 3\n", R"(
[motion]
peak = 3
[[change]]
at_s = 1
parameter = "kx_9_y1"
factor = 0.5
[[sensor]]
channel = "F9-Y1"
)");
  EXPECT_FALSE(r.scenario);
  EXPECT_TRUE(r.says("s.toml:1:", "sed")) << r.all();
  EXPECT_TRUE(r.says("s.toml:", "peak")) << r.all();
  EXPECT_TRUE(r.says("s.toml:", "kx_9_y1")) << r.all();
  EXPECT_TRUE(r.says("s.toml:", "F9-Y1")) << r.all();
}

TEST(Scenario, RefusesImpossibleValues) {
  EXPECT_TRUE(read("", "[sensors]\nbits = 16\n").says("s.toml:", "full scale"));
  EXPECT_TRUE(read("", "[truth]\nkx_npm = [[1e3, 2e3, 3e3]]\n").says("s.toml:", "kx_npm"));
  EXPECT_TRUE(read("", "[truth]\nkx_npm = \"soft\"\n").says("s.toml:", "kx_npm"));
  EXPECT_TRUE(read("rate_hz = 0\n", "").says("s.toml:1:", "rate_hz"));
  EXPECT_TRUE(read("", "[wind]\nspeed = 1\n").says("s.toml:", "wind"));
  EXPECT_TRUE(read("", "[change]\nat_s = 1\n").says("s.toml:", "[[change]]"));
  EXPECT_TRUE(read("", "[motion]\nfile = \"no-such.csv\"\n").says("", "no-such.csv"));
  // Reading two seconds of a motion of 1e8 samples took minutes.
  EXPECT_TRUE(read("", "[motion]\nlength_s = 1e6\n").says("s.toml:", "length_s"));
  EXPECT_TRUE(read("config = \"other.toml\"\n", "").says("s.toml:", "only one of both"));
  EXPECT_TRUE(read("rate_hz = [\n", "").says("s.toml:", ""));
  std::vector<ConfigProblem> problems;
  EXPECT_FALSE(load_scenario("/no/such/file.toml", problems));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].where, "/no/such/file.toml");
}

TEST(Scenario, RefusesTooLongOrTooLargeRunsBeforeAllocating) {
  EXPECT_TRUE(read("duration_s = 1e6\nrate_hz = 100000\n", "").says("s.toml:1", "1e+11 instants"));
  EXPECT_TRUE(read("", "[motion]\nlength_s = 1e6\n").says("s.toml", "motion.length_s"));
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("m.csv"), "time_s,a\n0,0\n1e-5,1\n2e-5,0\n");
  const Reading rest =
      read("", "[motion]\nfile = \"" + directory.path("m.csv") + "\"\nstart_s = 100000\n");
  EXPECT_TRUE(rest.says("s.toml", "s of rest are 1e+10 samples")) << rest.all();

  std::string tower = kBuilding.substr(0, kBuilding.find("[structure.design]"));
  tower.replace(tower.find("stories = 1"), 11, "stories = 500");
  tower.replace(tower.find("story_height_m = [1.0]"), 22, "story_height_m = 3.0");
  tower += kBuilding.substr(kBuilding.find("[[channel]]\nname = \"F0-X\""));
  for (int story = 1; story <= 500; ++story)
    for (const char* frame : {"y1", "y2", "x1", "x2"})
      tower += "[[channel]]\nname = \"F" + std::to_string(story) + frame +
               "\"\nstory = " + std::to_string(story) + "\nframe = \"" + frame + "\"\n";
  Reading high;
  high.scenario = read_scenario(tower, "s.toml", high.problems);
  EXPECT_FALSE(high.scenario);
  EXPECT_TRUE(high.says("s.toml", "500 stories of 4 frames have 2000 degrees of freedom"))
      << high.all();
}

TEST(Scenario, TheBuildingMayBeInASeparateFile) {
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("house.toml"), kBuilding);
  test::write_file(directory.path("shake.toml"), "config = \"house.toml\"\nduration_s = 3\n");
  std::vector<ConfigProblem> problems;
  const auto s = load_scenario(directory.path("shake.toml"), problems);
  ASSERT_TRUE(s) << (problems.empty() ? "" : problems[0].message);
  EXPECT_EQ(s->config.pipeline.axes.size(), 6u);
  EXPECT_EQ(s->duration_s, 3);
}

TEST(Scenario, TheShippedOnesLoad) {
  int found = 0;
  for (const auto& entry : std::filesystem::directory_iterator(FRAMEWATCH_SOURCE_DIR "/configs")) {
    const std::string name = entry.path().filename();
    if (!name.starts_with("scenario_")) continue;
    std::vector<ConfigProblem> problems;
    EXPECT_TRUE(load_scenario(entry.path(), problems)) << name;
    for (const ConfigProblem& p : problems) ADD_FAILURE() << p.where << ": " << p.message;
    ++found;
  }
  EXPECT_GE(found, 1);
}

}  // namespace scenario_test
}  // namespace framewatch::daemon
