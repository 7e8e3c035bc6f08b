// SPDX-License-Identifier: MIT
#include <filesystem>

#include <gtest/gtest.h>

#include "daemon/tools/commands/convert_command.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace implausible_records_test {

class ImplausibleRecords : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return directory_.path(name); }
  /// Converts text as rec.csv and returns the messages. The exit code must be `code`.
  std::string said(const std::string& text, int code, const std::string& config = "") {
    test::write_file(path("rec.csv"), text);
    std::filesystem::remove(path("rec.lcmlog"));
    const std::string out = converted("rec.csv", "rec.lcmlog", code, config);
    EXPECT_EQ(std::filesystem::exists(path("rec.lcmlog")), code == 0);
    return out;
  }
  std::string converted(const std::string& in, const std::string& out, int code,
                        const std::string& config = "") {
    ConvertArguments arguments;
    arguments.inputs = {path(in)};
    arguments.out = path(out);
    arguments.config = config;
    testing::internal::CaptureStderr();
    EXPECT_EQ(convert(arguments), code);
    return testing::internal::GetCapturedStderr();
  }

  test::TemporaryDirectory directory_;
};

void expect_holds(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "no " << part << " in: " << text;
}

TEST_F(ImplausibleRecords, AreReportedWithFileLineAndValue) {
  const std::string said_of =
      said("time_s,a,b\n0,1,200\n0.01,-1e9,-200\n0.02,350,1\n0.03,2,3\n", 0);
  expect_holds(said_of,
               "rec.csv:3: a: -1e+09 m/s^2 is beyond 200 m/s^2; 2 of 4 values are, the largest "
               "-1e+09 m/s^2");
  EXPECT_EQ(said_of.find(" b: "), std::string::npos) << said_of;
}

TEST_F(ImplausibleRecords, AreReportedWithTheRightLineAfterLostSamples) {
  expect_holds(said("time_s,a\n0,1\n0.01,1\n0.02,1\n0.05,1\n0.06,999\n", 0),
               "rec.csv:6: a: 999 m/s^2");
}

TEST_F(ImplausibleRecords, AreRefusedIfValuesAreImpossible) {
  expect_holds(said("time_s,a\n0,1\n0.01,1e300\n0.02,1\n", 2),
               "rec.csv:3: a: 1e+300 is not an acceleration");
}

TEST_F(ImplausibleRecords, WarnOfTimesInMillisecondsOrMicroseconds) {
  expect_holds(said("time_s,a\n0,1\n10,1\n20,1\n", 0),
               "rec.csv: 10 s from sample to sample, 0.1 Hz: is the time in seconds?");
  expect_holds(said("time_s,a\n0,1\n10000,1\n20000,1\n", 0), "0.0001 Hz: is the time in seconds?");
  expect_holds(said("time_s,a\n0,1\n0.00002,1\n0.00004,1\n", 0), "50000 Hz");
  EXPECT_EQ(said("time_s,a\n0,1\n0.01,1\n0.02,1\n", 0), "");
  EXPECT_EQ(said("time_s,a\n0,1\n1,1\n2,1\n", 0), "");
}

TEST_F(ImplausibleRecords, UseTheLimitsOfTheConfiguration) {
  const std::string config = path("config.toml");
  std::string text = test::read_file(FRAMEWATCH_SOURCE_DIR "/configs/mini_shake_table_xsens.toml");
  const std::string name = "name = \"floor-1\"";
  ASSERT_NE(text.find(name), std::string::npos);
  text.insert(text.find(name) + name.size(), "\nrange_mps2 = 20\nscale = 0.01");
  test::write_file(config, text);
  const std::string head = "time_s,ground,floor-1,floor-2,floor-3\n";
  const std::string said_of = said(head + "0,0,1999,30,0\n0.5,0,2100,1,0\n1,0,0,1,0\n", 0, config);
  expect_holds(said_of, "rec.csv:3: floor-1: 21 m/s^2 is beyond 20 m/s^2");
  EXPECT_EQ(said_of.find("floor-2"), std::string::npos) << said_of;
  expect_holds(said_of, "rec.csv: sampled at 2 Hz, but " + config + " has rate_hz = ");
}

TEST_F(ImplausibleRecords, AreReportedButConvertedInALog) {
  expect_holds(said("time_s,a\n0,1\n0.01,300\n0.02,1\n", 0), "rec.csv:3: a: 300 m/s^2");
  expect_holds(converted("rec.lcmlog", "back.csv", 0),
               "rec.lcmlog: at 0.010000 s: a: 300 m/s^2 is beyond 200 m/s^2");
}

}  // namespace implausible_records_test
}  // namespace framewatch::daemon
