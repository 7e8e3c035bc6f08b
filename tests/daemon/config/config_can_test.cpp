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

/// Returns kGoodConfig with its LCM source replaced by `source`, and `more` at its end.
std::string problems_of(const std::string& source, const std::string& more,
                        const std::string& dbc = kDbc) {
  const test::TemporaryDirectory directory;
  test::write_file(directory.path("n.dbc"), dbc);
  const std::string text =
      test::replaced(test::kGoodConfig, R"({ lcm = "ACCEL", node = 2, axis = "x" })", source) +
      more;
  std::vector<ConfigProblem> problems;
  parse_config(directory.path("c.toml"), text, problems);
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
