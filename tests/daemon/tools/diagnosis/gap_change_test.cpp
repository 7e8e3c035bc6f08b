// SPDX-License-Identifier: MIT
// A frame loses 10 % during or after learning of the gap's model. The model must be that of
// before, and the event must name the frame.
#include <gtest/gtest.h>

#include <framewatch/event_t.hpp>

#include "daemon/tools/replay/replay_command.h"
#include "daemon/tools/simulation/simulate_command.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace gap_change_test {

constexpr double kSeconds = 140;

/// Returns gap events of the demo's building when one frame loses a tenth at a time; learn_s = 60.
std::vector<event_t> gaps(double change_s, const std::string& parameter) {
  const test::TemporaryDirectory directory;
  const std::string configs = std::string(FRAMEWATCH_SOURCE_DIR) + "/configs/";
  std::string scenario = test::read_file(configs + "scenario_table_two_story.toml");
  const std::string config = "config = \"";
  scenario.insert(scenario.find(config) + config.size(), configs);
  scenario += "\n[[change]]\nat_s = " + std::to_string(change_s) + "\nparameter = \"" + parameter +
              "\"\nfactor = 0.9\n";
  test::write_file(directory.path("scenario.toml"), scenario);
  test::write_file(directory.path("building.toml"),
                   test::read_file(test::table_config()) + "\n[gap]\nlearn_s = 60\n");
  SimulateArguments s;
  s.scenario = directory.path("scenario.toml");
  s.out = directory.path("rec.lcmlog");
  s.seconds = kSeconds;
  s.quiet = true;
  EXPECT_EQ(simulate(s), 0);
  ReplayArguments a;
  a.config = directory.path("building.toml");
  a.inputs = {directory.path("rec.lcmlog")};
  a.out = directory.path("est.lcmlog");
  a.quiet = true;
  EXPECT_EQ(replay(a), 0);
  std::vector<event_t> out;
  drivers::LcmLogReader reader;
  EXPECT_TRUE(reader.open(directory.path("est.lcmlog")));
  drivers::LogEvent event;
  while (reader.next(event) == drivers::LogRead::event)
    if (event.channel == "FRAMEWATCH_EVENT")
      if (const auto m = drivers::decoded<event_t>(event.data); m && m->kind == "gap")
        out.push_back(*m);
  return out;
}

void expect_named(double change_s, const std::string& parameter) {
  const std::vector<event_t> found = gaps(change_s, parameter);
  ASSERT_EQ(found.size(), 1u) << change_s;
  EXPECT_EQ(found.front().place, parameter) << found.front().message;
  EXPECT_NE(found.front().message.find(" below the model"), std::string::npos)
      << found.front().message;
}

TEST(GapChange, NamesAChangeDuringLearning) {
  expect_named(36, "kx_1_y2");
}

TEST(GapChange, NamesAChangeAfterLearning) {
  expect_named(95, "ky_2_x1");
}

TEST(GapChange, LearnsTheChangedBuildingAfterAnEarlyChange) {
  EXPECT_TRUE(gaps(12, "kx_1_y2").empty());
}

}  // namespace gap_change_test
}  // namespace framewatch::daemon
