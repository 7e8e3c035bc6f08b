// SPDX-License-Identifier: MIT
// An estimation that is cut at any instant and resumed from its state must publish the same bytes
// as the uncut one: under every fault of the simulator, in buildings of every layout, with all
// options that have a state. FRAMEWATCH_STATE_CASES sets the number of random cases.

#include <algorithm>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/monitor/estimation/state_file.h"
#include "daemon/tools/simulation/scenario.h"
#include "daemon/tools/simulation/simulation_output.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace state_property_test {

constexpr int kCases = 5, kCuts = 4;
constexpr double kSeconds = 30, kCompared_s = 3;
constexpr unsigned kFirstSeed = 3800;

using Random = std::mt19937;

bool chance(Random& random, double share) {
  return std::uniform_real_distribution<>(0, 1)(random) < share;
}
double between(Random& random, double low, double high) {
  return std::uniform_real_distribution<>(low, high)(random);
}
template <typename T>
T any(Random& random, const std::vector<T>& of) {
  return of[random() % of.size()];
}

std::string channel_text(int node, int floor, const std::string& frame, char along,
                         const std::string& noise) {
  return fmt::format(
      "\n[[channel]]\nname = \"F{0}-{1}\"\nstory = {0}\nframe = \"{1}\"\nsource = {{ lcm = "
      "\"ACCEL\", node = {2}, "
      "axis = \"{3}\" }}\n{4}\n",
      floor, frame, node, along, noise);
}

/// Returns a building with sensors on these floors (0: the base), one on every frame of a floor.
std::string building_text(Random& random, int stories, const std::vector<int>& floors,
                          bool flexible) {
  std::string out = fmt::format(
      "[structure]\nname = \"a case\"\nstories = {}\nframes_x = [\"y1\", \"y2\"]\nframes_y = "
      "[\"x1\", \"x2\"]\n"
      "span_x_m = [1.0]\nspan_y_m = [1.0]\nstory_height_m = 1.0\nfloor = \"{}\"\nnode_mass_kg = "
      "20.0\n"
      "[structure.design]\nkx_npm = 38e3\nky_npm = 30e3\n{}damping_ratio = 0.015\n",
      stories, flexible ? "flexible" : "rigid", flexible ? "gk = 45e3\n" : "");
  out += fmt::format("[estimator]\nrate_hz = 100.0\nwindow_s = {}\nhop_s = {}\nself_tune = {}\n",
                     any<double>(random, {2, 3, 5}), any<double>(random, {0.01, 0.05}),
                     chance(random, 0.8) ? "true" : "false");
  if (chance(random, 0.5)) out += "other_windows_s = [1.0, 4.0]\n";
  if (chance(random, 0.7))
    out += fmt::format("[watch]\nlearn_s = {}\nfollow_amplitude = {}\n", between(random, 3, 8),
                       chance(random, 0.7) ? "true" : "false");
  if (chance(random, 0.5)) out += "[gap]\n";
  if (chance(random, 0.7)) out += "[event_report]\ndirectory = \"reports\"\nquiet_s = 2\n";
  const std::string noise = chance(random, 0.6) ? "noise_mps2_per_rthz = 5e-4" : "";
  int node = 0;
  for (const int floor : floors)
    for (const auto& [frame, along] : std::vector<std::pair<std::string, char>>{
             {"y1", 'x'}, {"y2", 'x'}, {"x1", 'y'}, {"x2", 'y'}})
      out += channel_text(node++, floor, frame, along, noise);
  return out;
}

/// Returns a fault of one channel.
std::string fault_text(Random& random, const std::string& channel) {
  const double from = between(random, 0, kSeconds);
  const std::string sensor = fmt::format("\n[[sensor]]\nchannel = \"{}\"\n", channel);
  const std::string effect = fmt::format("\n[[effect]]\nchannel = \"{}\"\nkind = ", channel);
  switch (random() % 12) {
    case 0:
      return sensor + fmt::format("dead_from_s = {}\n", from);
    case 1:
      return sensor + fmt::format("dead_from_s = {}\ndead_to_s = {}\n", from,
                                  from + between(random, 0.02, 8));
    case 2:
      return sensor + fmt::format("loss_ratio = {}\n", between(random, 0.001, 0.3));
    case 3:
      return sensor + "full_scale_g = 0.05\nbits = 12\n";
    case 4:
      return sensor + fmt::format("full_scale_g = 2.0\nbits = {}\n", random() % 8 + 4);
    case 5:
      return sensor + fmt::format("bias_mps2 = {}\nramp_mps3 = {}\n", between(random, -1, 1),
                                  between(random, -0.1, 0.1));
    case 6:
      return effect + "\"gain_error\"\ngain = 0.3\n";
    case 7:
      return effect + "\"polarity\"\n";
    case 8:
      return effect + fmt::format("\"time_shift\"\nshift_s = {}\n", between(random, 0, 0.05));
    case 9:
      return effect + fmt::format("\"clipping\"\nlevel_mps2 = {}\n", between(random, 0.2, 2));
    case 10:
      return effect + fmt::format("\"bias_drift\"\nramp_mps3 = 0.05\nfrom_s = {}\n", from);
    default: {  // toward a frame of the other direction: "F2-y1", "F2-x1"
      std::string other = channel;
      char& along = other[other.size() - 2];
      along = along == 'x' ? 'y' : 'x';
      return effect +
             fmt::format("\"misalignment\"\nwith_channel = \"{}\"\nangle_deg = 10\n", other);
    }
  }
}

std::string scenario_text(Random& random, const std::vector<int>& floors) {
  std::string out = fmt::format(
      "config = \"building.toml\"\nduration_s = {}\nseed = {}\n[truth]\ndamping_ratio = "
      "0.015\n[motion]\n"
      "peak_mps2 = {}\nstart_s = {}\nstrong_s = {}\ndecay_s = 1.0\nlength_s = {}\n[sensors]\n"
      "noise_mps2_per_rthz = 5e-4\n",
      kSeconds, random() % 1000 + 1, between(random, 0.3, 4), between(random, 0, 3),
      between(random, 8, 30), kSeconds + 10);
  std::vector<std::string> channels;
  for (const int floor : floors)
    for (const char* frame : {"y1", "y2", "x1", "x2"})
      channels.push_back(fmt::format("F{}-{}", floor, frame));
  std::shuffle(channels.begin(), channels.end(), random);
  channels.resize(random() % 4 + 1);
  for (const std::string& channel : channels) out += fault_text(random, channel);
  if (chance(random, 0.5))
    out += fmt::format("\n[[change]]\nat_s = {}\nparameter = \"kx_1_y1\"\nfactor = 0.75\n",
                       between(random, 5, 25));
  return out;
}

/// Changes the messages in transit: silence of all, a node that is silent every other second,
/// messages that come twice or in another order.
std::vector<drivers::LogEvent> on_their_way(Random& random, std::vector<drivers::LogEvent> events) {
  const std::int64_t start_us = events.front().timestamp_us;
  const auto second_of = [&](const drivers::LogEvent& e) {
    return 1e-6 * static_cast<double>(e.timestamp_us - start_us);
  };
  if (chance(random, 0.5)) {
    const double from = between(random, 2, 25), to = from + between(random, 0.05, 4);
    std::erase_if(events, [&](const auto& e) { return second_of(e) >= from && second_of(e) < to; });
  }
  if (chance(random, 0.3)) {
    std::size_t n = 0;
    std::erase_if(events, [&](const auto& e) {
      return n++ % 12 == 5 && static_cast<int>(second_of(e)) % 2 == 1;
    });
  }
  if (chance(random, 0.3))
    for (std::size_t i = 97; i + 1 < events.size(); i += 97) std::swap(events[i], events[i + 1]);
  if (chance(random, 0.3))
    for (std::size_t i = 53; i + 1 < events.size(); i += 53) events[i + 1] = events[i];
  return events;
}

/// A building and the messages of its sensors.
struct Case {
  Config config;
  std::vector<drivers::LogEvent> events;
};

Case recorded(const test::TemporaryDirectory& directory, const std::string& building,
              const std::string& scenario_text) {
  test::write_file(directory.path("building.toml"), building);
  test::write_file(directory.path("scenario.toml"), scenario_text);
  std::vector<ConfigProblem> problems;
  const auto config = load_config(directory.path("building.toml"), problems);
  const auto scenario =
      config ? load_scenario(directory.path("scenario.toml"), problems) : std::nullopt;
  for (const ConfigProblem& p : problems) ADD_FAILURE() << p.where << ": " << p.message;
  if (!scenario) return {};
  std::string error;
  const auto output = file_output(*scenario, directory.path("rec.lcmlog"), error);
  Simulation simulation(*scenario);
  for (std::int64_t i = 0; i < instants(*scenario); ++i) {
    const std::vector<double>& raw = simulation.next();
    EXPECT_TRUE(output->put(simulation.time_s(), raw));
  }
  EXPECT_TRUE(output->close());
  Case out{*config, {}};
  drivers::LcmLogReader reader;
  EXPECT_TRUE(reader.open(directory.path("rec.lcmlog")));
  for (drivers::LogEvent e; reader.next(e) == drivers::LogRead::event;) out.events.push_back(e);
  return out;
}

/// Returns a case with one of the layouts in turn: flexible floors and sensors on all, rigid ones,
/// sensors on some floors, sensors only on the base and the roof.
Case random_case(const test::TemporaryDirectory& directory, unsigned seed) {
  Random random(seed);
  const int layout = static_cast<int>(seed % 4);
  const std::vector<std::vector<int>> floors = {{0, 1, 2}, {0, 1, 2, 3}, {0, 2, 4, 6}, {0, 4}};
  const std::vector<int>& measured = floors[static_cast<std::size_t>(layout)];
  const std::string building = building_text(random, measured.back(), measured, layout == 0);
  Case out = recorded(directory, building, scenario_text(random, measured));
  if (!out.events.empty()) out.events = on_their_way(random, std::move(out.events));
  return out;
}

/// An estimation and all its output.
struct Saying {
  explicit Saying(const Config& config)
      : estimation(config, [this](std::int64_t time_us, const std::string& channel,
                                  const std::vector<std::uint8_t>& bytes) {
          said.push_back(fmt::format("{} {} ", time_us, channel) +
                         std::string(bytes.begin(), bytes.end()));
        }) {}
  void hear(const drivers::LogEvent& e) {
    estimation.message(e.channel, e.data.data(), e.data.size());
  }
  std::vector<std::string> said;
  Estimation estimation;
};

struct Cut {
  std::size_t event = 0, said = 0;
  SavedState state;
};

void expect_to_go_on(const Case& c, const std::vector<std::string>& uncut, const Cut& cut,
                     const test::TemporaryDirectory& directory) {
  SCOPED_TRACE(fmt::format("cut before event {} of {}", cut.event, c.events.size()));
  ASSERT_EQ(write_state(directory.path("state"), cut.state), "");
  Saying resumed(c.config);
  bool touched = false;
  ASSERT_EQ(load_state(directory.path("state"), c.config, resumed.estimation, touched).problem, "");
  const SavedState again = saved_state(c.config, resumed.estimation, 0);
  ASSERT_EQ(again.sections.size(), cut.state.sections.size());
  for (std::size_t s = 0; s < again.sections.size(); ++s)
    EXPECT_TRUE(again.sections[s].bytes == cut.state.sections[s].bytes) << again.sections[s].name;
  const std::int64_t until_us =
      c.events[cut.event].timestamp_us + static_cast<std::int64_t>(1e6 * kCompared_s);
  for (std::size_t e = cut.event; e < c.events.size() && c.events[e].timestamp_us < until_us; ++e)
    resumed.hear(c.events[e]);
  for (std::size_t i = 0; i < resumed.said.size(); ++i)
    ASSERT_TRUE(resumed.said[i] == uncut.at(cut.said + i))
        << "message " << i << " after the cut differs: " << resumed.said[i].substr(0, 50);
}

/// Cuts the estimation before the events `cuts` and resumes it.
void cut_and_go_on(const Case& c, std::vector<std::size_t> cuts,
                   const test::TemporaryDirectory& directory) {
  ASSERT_FALSE(c.events.empty());
  std::sort(cuts.begin(), cuts.end());
  Saying uncut(c.config);
  std::vector<Cut> taken;
  for (std::size_t e = 0; e < c.events.size(); ++e) {
    while (taken.size() < cuts.size() && cuts[taken.size()] == e)
      taken.push_back({e, uncut.said.size(), saved_state(c.config, uncut.estimation, 0)});
    uncut.hear(c.events[e]);
  }
  for (const Cut& cut : taken) {
    expect_to_go_on(c, uncut.said, cut, directory);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(StateProperty, ContinuesByteByByteFromRandomInstantsUnderEveryFault) {
  const char* wanted = std::getenv("FRAMEWATCH_STATE_CASES");
  const int cases = wanted == nullptr ? kCases : std::atoi(wanted);
  for (int n = 0; n < cases; ++n) {
    const unsigned seed = kFirstSeed + static_cast<unsigned>(n);
    SCOPED_TRACE(fmt::format("seed {}", seed));
    const test::TemporaryDirectory directory;
    const Case c = random_case(directory, seed);
    ASSERT_FALSE(c.events.empty());
    Random random(seed + 1'000'000);
    std::vector<std::size_t> cuts;
    for (int i = 0; i < kCuts; ++i) cuts.push_back(random() % c.events.size());
    cut_and_go_on(c, cuts, directory);
    if (HasFailure()) return;
  }
}

/// Regression: after the interruption the errors of the first windows were zero, and the sums of
/// the shaking infinite.
TEST(StateProperty, SurvivesTheLossOfAFloorSensorDuringShaking) {
  const test::TemporaryDirectory directory;
  Random random(7);
  const std::vector<int> floors = {0, 2, 4, 6};
  std::string building = building_text(random, 6, floors, false);
  building = building.substr(0, building.find("[estimator]")) +
             "[estimator]\nrate_hz = 100.0\nwindow_s = 3.0\nhop_s = 0.01\n[event_report]\n"
             "directory = \"reports\"\n";
  int node = 0;
  for (const int floor : floors)
    for (const auto& [frame, along] : std::vector<std::pair<std::string, char>>{
             {"y1", 'x'}, {"y2", 'x'}, {"x1", 'y'}, {"x2", 'y'}})
      building += channel_text(node++, floor, frame, along, "noise_mps2_per_rthz = 5e-4");
  const Case c = recorded(
      directory, building,
      "config = \"building.toml\"\nduration_s = 40.0\nseed = 3\n[truth]\ndamping_ratio = 0.015\n"
      "[motion]\npeak_mps2 = 2.0\nstrong_s = 60.0\nlength_s = 70.0\n[sensors]\n"
      "noise_mps2_per_rthz = 5e-4\n[[sensor]]\nchannel = \"F4-y1\"\ndead_from_s = 20.0\n");
  ASSERT_FALSE(c.events.empty());
  cut_and_go_on(c, {c.events.size() / 4, c.events.size() * 6 / 8, c.events.size() * 7 / 8},
                directory);
}

}  // namespace state_property_test
}  // namespace framewatch::daemon
