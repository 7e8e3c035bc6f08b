// SPDX-License-Identifier: MIT
#include "daemon/tools/commands/convert_command.h"

#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/core.h>
#include <gtest/gtest.h>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "drivers/files/encoded.h"
#include "drivers/formats/record_file.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/lcm_log.h"
#include "tests/support/data.h"
#include "tests/support/station_files.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace convert_command_test {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

class Convert : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return directory_.path(name); }
  ConvertArguments from(const std::vector<std::string>& inputs, const std::string& out) const {
    ConvertArguments arguments;
    arguments.inputs = inputs;
    arguments.out = path(out);
    return arguments;
  }
  /// Expects exit 2, this message on stderr, and no new file.
  void expect_refused(const ConvertArguments& arguments, const std::string& rule) {
    const auto before = directory_.names();
    testing::internal::CaptureStderr();
    EXPECT_EQ(convert(arguments), 2);
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_NE(said.find(rule), std::string::npos) << "expected: " << rule << "\nsaid: " << said;
    EXPECT_EQ(directory_.names(), before);
  }

  test::TemporaryDirectory directory_;
};

TEST_F(Convert, CsvToLogAndBackIsTheSameText) {
  const std::string text = "time_s,F1-Y1,F0\n0,0.1,-2\n0.005,,3\n0.01,1e-300,0.3333333333333333\n";
  test::write_file(path("rec.csv"), text);
  ASSERT_EQ(convert(from({path("rec.csv")}, "rec.lcmlog")), 0);
  ASSERT_EQ(convert(from({path("rec.lcmlog")}, "back.csv")), 0);
  EXPECT_EQ(test::read_file(path("back.csv")), text);
  EXPECT_EQ(directory_.names(), (std::vector<std::string>{"back.csv", "rec.csv", "rec.lcmlog"}));
}

TEST_F(Convert, ReportsHeaderFieldsThatItDrops) {
  test::write_file(path("station.v1"), test::cosmos());
  test::write_file(path("plain.csv"), "time_s,a\n0,1\n0.5,2\n");
  const auto said = [&](const std::string& in, const std::string& out) {
    testing::internal::CaptureStderr();
    EXPECT_EQ(convert(from({path(in)}, out)), 0);
    return testing::internal::GetCapturedStderr();
  };
  const std::string of_log = said("station.v1", "station.lcmlog"),
                    of_table = said("station.v1", "station.csv");
  EXPECT_NE(of_log.find("does not keep what the headers say of NP.8040.01.HNE: name"),
            std::string::npos)
      << of_log;
  EXPECT_NE(of_table.find("NP.8040.01.HNE: direction, place and unit"), std::string::npos)
      << of_table;
  EXPECT_EQ(said("plain.csv", "plain.lcmlog").find("headers"), std::string::npos);
}

TEST_F(Convert, StartsAtTheRequestedSensorTime) {
  test::write_file(path("rec.csv"), "time_s,a\n0,1\n0.5,2\n");
  auto arguments = from({path("rec.csv")}, "rec.lcmlog");
  arguments.start_us = 7'000'000;
  arguments.channel = "OTHER";
  ASSERT_EQ(convert(arguments), 0);
  ASSERT_EQ(convert(from({path("rec.lcmlog")}, "back.csv")), 0);
  EXPECT_EQ(test::read_file(path("back.csv")), "time_s,a\n7,1\n7.5,2\n");
}

TEST_F(Convert, SendsNamedColumnsToConfiguredAddresses) {
  const std::string config_path = FRAMEWATCH_SOURCE_DIR "/configs/mini_shake_table_xsens.toml";
  test::write_file(path("rec.csv"),
                   "time_s,floor-3,extra,ground,floor-1,floor-2\n0,3,9,0,1,2\n0.01,6,9,0,2,4\n");
  auto arguments = from({path("rec.csv")}, "rec.lcmlog");
  arguments.config = config_path;
  ASSERT_EQ(convert(arguments), 0);
  ASSERT_EQ(convert(from({path("rec.lcmlog")}, "back.csv")), 0);
  EXPECT_EQ(test::read_file(path("back.csv")),
            "time_s,ground,floor-1,floor-2,floor-3\n0,0,1,2,3\n0.01,0,2,4,6\n");
  drivers::LcmLogReader log;
  ASSERT_TRUE(log.open(path("rec.lcmlog")));
  for (drivers::LogEvent event; log.next(event) == drivers::LogRead::event;) {
    const auto sample = drivers::decode_accel(event.data.data(), event.data.size());
    if (!sample || sample->sequence != 0) continue;
    EXPECT_EQ(sample->accel_abs_mps2[0], sample->node);
  }
  arguments.inputs = {path("back.csv")};
  arguments.config = FRAMEWATCH_SOURCE_DIR "/configs/table_two_story.toml";
  arguments.out = path("o.lcmlog");
  expect_refused(arguments, "is not in the record");
}

TEST_F(Convert, RefusesBadUseAndWritesNothing) {
  test::write_file(path("rec.csv"), "time_s,a\n0,1\n0.5,2\n");
  test::write_file(path("col.txt"), "1\n2\n");
  test::write_file(path("bad.csv"), "time_s,a\n0,1\n0.5,x\n");
  expect_refused(from({path("rec.csv")}, "rec.txt"), "must end in .lcmlog");
  expect_refused(from({path("rec.csv")}, "rec.csv"), "is input and output");
  expect_refused(from({path("none.csv")}, "o.lcmlog"), "cannot be opened");
  expect_refused(from({path("bad.csv")}, "o.lcmlog"), "bad.csv:3: a: \"x\"");
  expect_refused(from({path("col.txt")}, "o.lcmlog"), "declare it with --unit");
  expect_refused(from({path("rec.csv"), path("rec.csv")}, "o.lcmlog"), "appears twice");
  expect_refused(from({path("rec.csv")}, "no/o.lcmlog"), "No such file");
  auto arguments = from({path("rec.csv")}, "o.lcmlog");
  arguments.record.unit = "furlong";
  expect_refused(arguments, "not g, mg, gal or mps2");
  arguments = from({path("rec.csv")}, "o.lcmlog");
  arguments.record.format = "tape";
  expect_refused(arguments, "'tape'");
  arguments = from({path("rec.csv")}, "o.lcmlog");
  arguments.boxplot = true;
  expect_refused(arguments, "--boxplot");
  arguments = from({path("rec.csv")}, "o.lcmlog");
  arguments.config = path("none.toml");
  expect_refused(arguments, "none.toml");
}

TEST_F(Convert, ReadsASpreadsheetAndNeverInterleavesColumns) {
  test::write_file(path("sheet.csv"), "\xEF\xBB\xBFTime;a [m/s2]\r\n0;0,5\r\n0,01;-1\r\n");
  ASSERT_EQ(convert(from({path("sheet.csv")}, "o.csv")), 0);
  EXPECT_EQ(test::read_file(path("o.csv")), "time_s,a\n0,0.5\n0.01,-1\n");
  test::write_file(path("three.txt"), "0.00 1 2\n0.01 3 4\n0.02 5 6\n");
  auto arguments = from({path("three.txt")}, "o.lcmlog");
  arguments.record.unit = "g";
  arguments.record.step_s = 0.01;
  expect_refused(arguments, "can be read in two ways");
  arguments.record = {};
  arguments.record.zone = "Tokyo";
  arguments.record.decimal = "dot";
  arguments.record.time_unit = "h";
  expect_refused(arguments, "'dot' is not comma or point");
}

template <typename Type>
void put(drivers::LcmLogWriter& log, const std::string& channel, const Type& message) {
  const std::vector<std::uint8_t> bytes = drivers::encoded(message);
  ASSERT_TRUE(log.write(0, channel, bytes.data(), bytes.size()));
}

parameter_table_t table() {
  parameter_table_t t{};
  t.parameters = 2;
  t.name = {"kx_1_y1", "cx_1_y1"};
  t.unit = {"N/m", "N*s/m"};
  t.kind = {0, 2};
  t.story = {1, 1};
  t.design = {0, 0};
  return t;
}

window_estimate_t window(std::int32_t status) {
  window_estimate_t e{};
  e.window_end_us = 5'010'000;
  e.status = status;
  e.parameters = 2;
  e.value = {250000.125, kNothing};
  e.std_error = {12.5, kNothing};
  e.reason = {0, 2};
  e.snr = e.prior_share = e.noise_share = {0, 0};
  return e;
}

TEST_F(Convert, WritesEstimatesInTheDocumentedFormat) {
  drivers::LcmLogWriter log;
  ASSERT_TRUE(log.open(path("est.lcmlog")));
  put(log, "FRAMEWATCH_PARAMETERS", table());
  auto estimate = window(1);
  estimate.boxplots = 2;
  estimate.q1 = {1, kNothing};
  estimate.median = {2, kNothing};
  estimate.q3 = {3, kNothing};
  estimate.whisker_low = {0.5, kNothing};
  estimate.whisker_high = {3.5, kNothing};
  estimate.outliers = {4, 0};
  estimate.boxplot_count = {500, 0};
  put(log, "FRAMEWATCH_ESTIMATE", estimate);
  put(log, "FRAMEWATCH_ESTIMATE", window(0));
  ASSERT_TRUE(log.close());
  ASSERT_EQ(convert(from({path("est.lcmlog")}, "est.csv")), 0);
  EXPECT_EQ(test::read_file(path("est.csv")),
            "window_end_s,status,kx_1_y1,kx_1_y1.std_error,kx_1_y1.observable,"
            "cx_1_y1,cx_1_y1.std_error,cx_1_y1.observable\n"
            "5.01,valid,250000.125,12.5,1,,,0\n"
            "5.01,warming_up,250000.125,12.5,1,,,0\n");
  auto arguments = from({path("est.lcmlog")}, "box.csv");
  arguments.boxplot = true;
  ASSERT_EQ(convert(arguments), 0);
  const std::string text = test::read_file(path("box.csv"));
  EXPECT_NE(text.find("kx_1_y1.observable,kx_1_y1.q1,kx_1_y1.median,kx_1_y1.q3,"
                      "kx_1_y1.whisker_low,kx_1_y1.whisker_high,kx_1_y1.outliers,cx_1_y1,"),
            std::string::npos);
  EXPECT_NE(text.find("5.01,valid,250000.125,12.5,1,1,2,3,0.5,3.5,4,,,0,,,,,,\n"),
            std::string::npos);
  EXPECT_NE(text.find("5.01,warming_up,250000.125,12.5,1,,,,,,,,,0,,,,,,\n"), std::string::npos);
}

TEST_F(Convert, RefusesEstimatesThatBreakTheirRules) {
  const auto refuse = [&](const std::string& rule, bool with_table, window_estimate_t estimate) {
    drivers::LcmLogWriter log;
    ASSERT_TRUE(log.open(path("est.lcmlog")));
    if (with_table) put(log, "FRAMEWATCH_PARAMETERS", table());
    put(log, "FRAMEWATCH_ESTIMATE", window(1));
    put(log, "FRAMEWATCH_ESTIMATE", estimate);
    ASSERT_TRUE(log.close());
    expect_refused(from({path("est.lcmlog")}, "est.csv"), rule);
  };
  refuse("no parameter_table_t", false, window(1));
  refuse("status 3", true, window(3));
  auto unseen = window(1);
  unseen.reason[1] = 0;
  refuse("observable and has no value", true, unseen);
  auto narrow = window(1);
  narrow.parameters = 1;
  refuse("1 parameters where the table has 2", true, narrow);
}

TEST_F(Convert, RefusesForeignLogs) {
  FRAMEWATCH_DATA_OR_SKIP(log, "lcm_logs/lcm-proj_example.lcmlog");
  expect_refused(from({log}, "o.csv"), "neither accelerations nor estimates");
}

std::vector<std::string> levels(const std::string& run, const std::string& stamp) {
  const std::string root = "mini_shake_table_xsens_2025/Flexible_vs_Stiff/Flexible_3_story/";
  std::vector<std::string> found;
  for (const char* level : {"Ground_Floor/(%)Xsens_DOT", "1st_Floor/(%)Xsens_DOT",
                            "2nd_Floor/(%)left_leg", "3rd_Floor_top/(%)Xsens_DOT"}) {
    std::string name = level;
    name.replace(name.find('%'), 1, run);
    if (const auto file = test::data_path(root + name + stamp)) found.push_back(*file);
  }
  return found;
}

TEST_F(Convert, JoinsTheFourLevelsOfATableTestInOneLog) {
  // The second floor's file of this run begins and ends one sample before the others.
  const auto files = levels("Sine_1.0", "_20250306_122116.csv.gz");
  if (files.size() != 4) GTEST_SKIP() << "no mini_shake_table_xsens_2025 under FRAMEWATCH_DATA";
  ASSERT_EQ(convert(from(files, "run.lcmlog")), 0);
  ASSERT_EQ(convert(from({path("run.lcmlog")}, "run.csv.gz")), 0);
  std::vector<drivers::Problem> problems;
  const auto merged = drivers::read_record(path("run.csv.gz"), {}, problems);
  ASSERT_TRUE(merged);
  EXPECT_EQ(merged->names.size(), 12U);
  EXPECT_EQ(merged->names[9], "node3.x");
  EXPECT_EQ(merged->time_s.size(), 19339U);
  EXPECT_EQ(merged->time_s.front(), 0);
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto single = drivers::read_record(files[i], {}, problems);
    ASSERT_TRUE(single);
    EXPECT_EQ(merged->accel_mps2[3 * i].front(), single->accel_mps2[0][i == 2 ? 1 : 0]);
  }
}

TEST_F(Convert, RefusesLevelsWhoseClocksDoNotOverlap) {
  const auto ground = test::data_path(
      "mini_shake_table_xsens_2025/Flexible_vs_Stiff/Flexible_3_story/Ground_Floor/"
      "(Bonus_Event)_D422CD00556E_20250411_114950.csv.gz");
  const auto first = test::data_path(
      "mini_shake_table_xsens_2025/Flexible_vs_Stiff/Flexible_3_story/1st_Floor/"
      "(Bonus_Event)_D422CD005686_20250411_114950.csv.gz");
  if (!ground || !first) GTEST_SKIP() << "no Bonus_Event run under FRAMEWATCH_DATA";
  expect_refused(from({*ground, *first}, "o.lcmlog"), "the clocks do not overlap");
}

TEST(ConvertProgram, HasHelpWithExamplesAndExitCodes) {
  const std::string program = FRAMEWATCH_PROGRAM;
  EXPECT_EQ(std::system((program + " convert --help | grep -q Examples").c_str()), 0);
  const int status = std::system((program + " convert only-one 2>/dev/null >&2").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 2);
}

TEST_F(Convert, DenoisesEveryChannelOfARecord) {
  // GIVEN a channel that repeats every 200 samples and the same with noise
  std::string text = "time_s,clean,noisy\n";
  for (int i = 0; i < 1000; ++i) {
    const double clean = std::sin(2 * M_PI * 3 * i / 200);
    const double noise = 0.1 * std::sin(17.0 * i * i);
    text += fmt::format("{},{},{}\n", 0.01 * i, clean, clean + noise);
  }
  test::write_file(path("rec.csv"), text);
  auto arguments = from({path("rec.csv")}, "out.csv");
  arguments.denoise = true;
  testing::internal::CaptureStderr();
  ASSERT_EQ(convert(arguments), 0);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("p = 200, q = 5"), std::string::npos);
  // THEN the first is unchanged, and the second is nearer to it
  std::vector<drivers::Problem> problems;
  const auto out = drivers::read_record(path("out.csv"), {}, problems);
  ASSERT_TRUE(out);
  double before = 0, after = 0;
  for (std::size_t i = 0; i < 1000; ++i) {
    const double clean = std::sin(2 * M_PI * 3 * static_cast<double>(i) / 200);
    EXPECT_NEAR(out->accel_mps2[0][i], clean, 1e-9);
    before += std::pow(0.1 * std::sin(17.0 * static_cast<double>(i * i)), 2);
    after += std::pow(out->accel_mps2[1][i] - clean, 2);
  }
  EXPECT_LT(after, 0.5 * before);
}

TEST_F(Convert, DenoisingNeedsAStretchWithoutHoles) {
  test::write_file(path("short.csv"), "time_s,a\n0,1\n0.01,2\n");
  std::string text = "time_s,a,b\n";
  for (int i = 0; i < 1000; ++i)
    text += fmt::format("{},{},{}\n", 0.01 * i, i % 7, i == 500 ? "" : "1");
  test::write_file(path("holes.csv"), text);
  auto arguments = from({path("short.csv")}, "out.csv");
  arguments.denoise = true;
  expect_refused(arguments, "needs 1000 samples");
  arguments.inputs = {path("holes.csv")};
  expect_refused(arguments, "b has missing samples");
}

}  // namespace convert_command_test
}  // namespace framewatch::daemon
