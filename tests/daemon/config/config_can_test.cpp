// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "tests/support/config_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace config_can_test {

const char* const kDbc = R"(VERSION ""
BS_:
BU_: A
BO_ 384 Accel: 8 A
 SG_ X : 0|16@1- (0.001,0) [0|0] "" A
 SG_ Y : 16|16@1- (0.001,0) [0|0] "" A
 SG_ Count : 48|16@1+ (1,0) [0|0] "" A
BO_ 400 Big: 64 A
 SG_ X_0 : 0|16@1- (0.001,0) [0|0] "" A
)";

/// Returns kGoodConfig with its LCM source replaced by `source`, and `more` at its end. Appends its
/// problems.
std::optional<Config> config_of(const std::string& source, const std::string& more,
                                const std::string& dbc, std::vector<ConfigProblem>& problems) {
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("n.dbc"), dbc);
  const std::string text =
      test::replaced(test::kGoodConfig, R"({ lcm = "ACCEL", node = 2, axis = "x" })", source) +
      more;
  return parse_config(directory.path("c.toml"), text, problems);
}

std::string problems_of(const std::string& source, const std::string& more,
                        const std::string& dbc = kDbc) {
  std::vector<ConfigProblem> problems;
  (void)config_of(source, more, dbc, problems);
  std::string all;
  for (const ConfigProblem& p : problems)
    all += p.where.substr(p.where.rfind('/') + 1) + ": " + p.message + "\n";
  return all;
}

const std::string kBus = "[[can]]\ninterface = \"can0\"\ndbc = [\"n.dbc\"]\n";
const std::string kNode = "[[can_node]]\nname = \"N\"\nmessages = [\"Accel\"]\n";
const std::string kX = R"({ can = "can0", dbc_signal = "Accel.X" })";

TEST(ConfigCan, ReportsEveryProblemAtItsPlace) {
  const auto expect = [](const std::string& all, const std::string& part) {
    EXPECT_NE(all.find(part), std::string::npos) << part << "\nin\n" << all;
  };
  EXPECT_EQ(problems_of(kX, kBus), "");
  EXPECT_EQ(problems_of(kX, kBus + kNode + "counter = \"Accel.Count\"\n"), "");
  expect(problems_of(kX, ""), "no [[can]] has interface = \"can0\"");
  expect(problems_of(R"({ can = "can1", dbc_signal = "Accel.X" })", kBus),
         "no [[can]] has interface = \"can1\", did you mean can0?");
  expect(problems_of(R"({ can = "can0", dbc_signal = "Acel.X" })", kBus),
         "no DBC file of the bus has the message Acel, did you mean Accel?");
  expect(problems_of(R"({ can = "can0", dbc_signal = "Accel.Q" })", kBus),
         "message Accel has no signal Q");
  expect(problems_of(R"({ can = "can0", dbc_signal = "Accel" })", kBus), "expected Message.Signal");
  expect(problems_of(R"({ can = "can0", dbc_signal = "Accel.X", axis = "x" })", kBus),
         "unknown key axis");
  expect(problems_of(R"({ can = "can0" })", kBus), "dbc_signal: is missing");
  expect(problems_of(kX, kBus + kBus), "can0 has a [[can]] already");
  expect(problems_of(kX, kBus + kNode + kNode), "N is the name of another node");
  expect(problems_of(kX, kBus + kNode + test::replaced(kNode, "\"N\"", "\"M\"")),
         "can_node: is missing: N and M have the message Accel");
  expect(problems_of(R"({ can = "can0", dbc_signal = "Accel.X", can_node = "O" })", kBus + kNode),
         "no [[can_node]] is named \"O\"");
  expect(problems_of(kX, kBus + kNode + "counter = \"Accel.Cont\"\n"), "did you mean Count?");
  expect(problems_of(kX, kBus + kNode + "timing = \"clock\"\n"), "clock: is missing for timing");
  expect(problems_of(kX, kBus + kNode + "timing = \"period\"\ncounter = \"Accel.Count\"\n"),
         "counter: is not used with this timing");
  expect(problems_of(kX, kBus + kNode + "timing = \"sync\"\nlatency_s = 0.001\n"), "latency_s:");
  expect(problems_of(kX, kBus + kNode + "delay_s = 0.001\n"), "delay_s:");
  expect(problems_of(kX, kBus + kNode + "id_offset = 2000\n"), "id_offset: id 950 of Accel");
  expect(problems_of(kX, kBus + kNode + "j1939 = true\n"), "j1939: Accel has an 11-bit id");
  expect(problems_of(kX, kBus + kNode + "samples_per_frame = 2\n"),
         "write # in place of the sample's number");
  expect(problems_of(R"({ can = "can0", dbc_signal = "Big.X_0" })", kBus),
         "Big has 64 bytes: fd = true is missing for can0");
  expect(problems_of(kX, test::replaced(kBus, "n.dbc", "none.dbc")), "none.dbc: ");
  expect(problems_of(kX, kBus, "BO_ 384 Accel: 8\n"), "n.dbc:1: expected a length in bytes");
}

/// Messages that no channel uses: a J1939 transport message, overlaps, two multiplexors without
/// SG_MUL_VAL_, impossible ids, a name and an id given twice, a type of a missing signal.
const std::string kOthers = R"(BO_ 2566834942 Diagnostic: 14 A
 SG_ Lamp : 0|8@1+ (1,0) [0|255] "" A
BO_ 800 Other: 8 A
 SG_ A : 0|16@1+ (1,0) [0|255] "" A
 SG_ ALow : 0|8@1+ (1,0) [0|255] "" A
BO_ 801 Switched: 8 A
 SG_ S0 M : 0|4@1+ (1,0) [0|0] "" A
 SG_ T0 M : 4|4@1+ (1,0) [0|0] "" A
 SG_ S2 m1 : 16|8@1+ (1,0) [0|0] "" A
BO_ 5000 TooLarge: 8 A
BO_ 802 Twice: 8 A
BO_ 802 Twice: 8 A
SIG_VALTYPE_ 802 None : 1;
)";

TEST(ConfigCan, PassesOverMessagesWithoutAChannel) {
  EXPECT_EQ(problems_of(kX, kBus, kDbc + kOthers), "");
  EXPECT_EQ(problems_of(kX, kBus + kNode + "counter = \"Accel.Count\"\n", kDbc + kOthers), "");
  const auto used = [&](const std::string& signal) {
    return problems_of(R"({ can = "can0", dbc_signal = ")" + signal + "\" }", kBus, kDbc + kOthers);
  };
  const auto expect = [](const std::string& all, const std::string& part) {
    EXPECT_NE(all.find(part), std::string::npos) << part << "\nin\n" << all;
  };
  expect(used("Diagnostic.Lamp"), "n.dbc:10: Diagnostic: no CAN frame has 14 bytes");
  expect(used("Other.A"), "n.dbc:14: signal ALow overlaps A (line 13)");
  expect(used("Switched.S2"), "n.dbc:18: signal S2: Switched has two multiplexors, S0 and T0");
  const std::string twice = std::string(kDbc) + R"(BO_ 384 Again: 8 A
)";
  expect(problems_of(kX, kBus, twice), "n.dbc:4: Accel has the id of Again (line 10)");
}

TEST(ConfigCan, DoubtsUnitsThatAChannelDoesNotConvert) {
  const auto doubts_of = [](const std::string& unit, const std::string& scale = "") {
    std::string dbc = kDbc;
    dbc.replace(dbc.find("\"\" A\n SG_ Y"), 2, "\"" + unit + "\"");
    std::vector<ConfigProblem> problems;
    const auto config = config_of(kX + "\n" + scale, kBus, dbc, problems);
    EXPECT_EQ(test::told(problems), "");
    std::string all;
    for (const ConfigProblem& p : config.value_or(Config{}).doubts)
      if (p.message.find("n.dbc") != std::string::npos)
        all += p.where.substr(p.where.rfind('/') + 1) + ": " + p.message + "\n";
    return all;
  };
  const auto expect = [](const std::string& all, const std::string& part) {
    EXPECT_NE(all.find(part), std::string::npos) << part << "\nin\n" << all;
  };
  for (const char* unit : {"", "m/s^2", "m/s\xB2", "mps2"}) EXPECT_EQ(doubts_of(unit), "") << unit;
  expect(doubts_of("g"), "X is in \"g\", which is 9.80665 m/s^2, and the channel has no scale");
  expect(doubts_of("g"), "set scale = 9.80665");
  expect(doubts_of("mg"), "set scale = 0.00980665");
  expect(doubts_of("cm/s^2"), "set scale = 0.01");
  expect(doubts_of("rad/s"), "X is in \"rad/s\", which is not a unit of acceleration");
  expect(doubts_of("N"), "which is not a unit of acceleration");
  EXPECT_EQ(doubts_of("g", "scale = 9.80665"), "");
  EXPECT_EQ(doubts_of("counts", "scale = 0.001"), "");
  EXPECT_EQ(doubts_of("N", "quantity = \"force\""), "");
  expect(doubts_of("kN", "quantity = \"force\""), "which is 1000 N");
  expect(doubts_of("m/s^2", "quantity = \"force\""), "which is not a unit of force");
}

TEST(ConfigCan, FollowsMultiplexorsOfMultiplexors) {
  std::vector<ConfigProblem> problems;
  const auto config = config_of(kX, kBus, R"(BU_: A
BO_ 384 Accel: 8 A
 SG_ S0 M : 0|8@1+ (1,0) [0|0] "" A
 SG_ S1 m4M : 8|8@1+ (1,0) [0|0] "" A
 SG_ X m1 : 16|16@1- (0.001,0) [0|0] "m/s^2" A
SG_MUL_VAL_ 384 S1 S0 4-5;
SG_MUL_VAL_ 384 X S1 1-2, 9-9;
)",
                                problems);
  ASSERT_TRUE(config) << test::told(problems);
  const auto& switches = config->can.nodes.at(0).messages.at(0).switches;
  ASSERT_EQ(switches.size(), 2u);
  EXPECT_EQ(switches[0].field.start, 8);
  EXPECT_EQ(switches[0].values, std::vector<drivers::ValueRange>({{1, 2}, {9, 9}}));
  EXPECT_EQ(switches[1].field.start, 0);
  EXPECT_EQ(switches[1].values, std::vector<drivers::ValueRange>({{4, 5}}));
}

TEST(ConfigCan, ReportsAMessageOfTwoNodes) {
  const std::string two = kBus + kNode + test::replaced(kNode, "\"N\"", "\"M\"");
  std::string text = test::replaced(test::kGoodConfig, R"({ lcm = "ACCEL", node = 2, axis = "x" })",
                                    R"({ can = "can0", dbc_signal = "Accel.X", can_node = "N" })");
  text = test::replaced(text, "name = \"F1-Y2\"\n",
                        "name = \"F1-Y2\"\nsource = { can = \"can0\", dbc_signal = \"Accel.X\", "
                        "can_node = \"M\" }\n");
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("n.dbc"), kDbc);
  std::vector<ConfigProblem> problems;
  EXPECT_FALSE(parse_config(directory.path("c.toml"), text + two, problems));
  EXPECT_NE(test::told(problems).find("Accel has the same id as Accel of node N: 180"),
            std::string::npos)
      << test::told(problems);
}

}  // namespace config_can_test
}  // namespace framewatch::daemon
