// SPDX-License-Identifier: MIT
// Tests why a parameter has no value, over half a minute of strong shaking.
#include <functional>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/tools/simulation/simulate_command.h"
#include "tests/daemon/tools/replay/replay_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace reasons_test {

constexpr double kSeconds = 30;
constexpr int kFirst = 100, kWindow = 500;
constexpr int kWarmUp = 1000;  // windows, of a hundred a second, and some
constexpr const char* kChannel = "F1-Y1";

class Reasons : public testing::Test {
 protected:
  /// Counts windows without a value by reason, for every parameter, when a channel is spoilt.
  nlohmann::json of(const std::function<std::string(const std::string&)>& spoilt) {
    SimulateArguments s;
    s.scenario = std::string(FRAMEWATCH_SOURCE_DIR) + "/configs/scenario_table_two_story.toml";
    s.out = directory_.path("rec.csv");
    s.seconds = kSeconds;
    s.quiet = true;
    EXPECT_EQ(simulate(s), 0);
    std::istringstream lines(test::read_file(s.out));
    std::string line, out;
    int column = -1;
    while (std::getline(lines, line)) {
      std::istringstream cells(line);
      std::string cell;
      for (int c = 0; std::getline(cells, cell, ','); ++c) {
        if (cell == kChannel)
          column = c;
        else if (c == column)
          cell = spoilt(cell);
        out += (c == 0 ? "" : ",") + cell;
      }
      out += "\n";
    }
    test::write_file(directory_.path("spoilt.csv"), out);
    const auto said = test::replay_of({directory_.path("spoilt.csv")}, "", true);
    EXPECT_EQ(said.exit_code, 0) << said.err;
    const nlohmann::json summary = nlohmann::json::parse(said.out);
    nlohmann::json found;
    for (const auto& p : summary["parameters"]) found[p["name"].get<std::string>()] = p["reasons"];
    return found;
  }

  test::TemporaryDirectory directory_;
};

TEST_F(Reasons, DoNotCallAReversedChannelQuiet) {
  const nlohmann::json found =
      of([](const std::string& cell) { return cell[0] == '-' ? cell.substr(1) : "-" + cell; });
  const nlohmann::json& own = found["kx_1_y1"];
  EXPECT_EQ(own["ok"], 0);
  EXPECT_LT(own["quiet"], kFirst) << own;
  EXPECT_GT(own["too uncertain"], 500) << own;
}

TEST_F(Reasons, NameADeadChannelOnItsWholeFlexibleFloor) {
  const nlohmann::json found = of([](const std::string&) { return std::string("0"); });
  for (const char* name : {"kx_1_y1", "kx_1_y2", "ky_1_x1", "cx_1_y2", "Gk_1_x1y1"}) {
    EXPECT_LT(found[name]["warming up"], kWarmUp) << name << found[name];
    EXPECT_GT(found[name]["channel lost"], kWarmUp) << name << found[name];
    // A dead channel is detected after half a second; its rows stay for a window.
    EXPECT_LT(found[name]["ok"], kWindow) << name;
  }
  EXPECT_GT(found["kx_2_y2"]["ok"], kWarmUp) << found["kx_2_y2"];
}

}  // namespace reasons_test
}  // namespace framewatch::daemon
