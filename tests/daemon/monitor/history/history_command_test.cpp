// SPDX-License-Identifier: MIT
#include <framewatch/event_t.hpp>
#include <framewatch/temperature_t.hpp>

#include "daemon/monitor/history/history_command.h"

#include <libmseed.h>
#include <matio.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_keeper.h"
#include "daemon/monitor/history/raw_history.h"
#include "daemon/monitor/history/summary_store.h"
#include "drivers/files/encoded.h"
#include "drivers/formats/record_file.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/accel_log.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/message_check.h"
#include "tests/support/history_fixture.h"
#include "tests/support/recorded_table_test.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace history_command_test {

constexpr std::int64_t kStart_us = 1'795'305'600'000'000;  // 2026-11-22T00:00:00Z
constexpr int kRate_hz = 100, kAxes = 10, kInstants = 1000, kLostFrom = 500, kLostTo = 550;
constexpr int kBetweenReadings = 300;  // instants between two readings of the thermometer

std::int32_t count(int instant, int axis) {
  return (instant * 7919 + axis * 104729) % 2'000'003 - 1'000'000;
}

/// Ten seconds of the table, half a second of them lost on every channel, and the history of them.
class HistoryCommand : public testing::Test {
 protected:
  HistoryCommand() : config_(test::table_with_history(directory_.path("h"))) {
    config_.history->rotate_s = 4;
    HistoryKeeper keeper(*config_.history);
    RawHistory raw(config_, [&](auto log) { keeper.retire(std::move(log)); });
    for (int i = 0; i < kInstants; ++i) {
      if (i >= kLostFrom && i < kLostTo) continue;
      const std::int64_t time_us = kStart_us + i * kSecond_us / kRate_hz;
      if (i % kBetweenReadings == 0)
        raw.message("TEMPERATURE", time_us, drivers::encoded(temperature_t{time_us, 0.01 * i}));
      for (int axis = 0; axis < kAxes; ++axis)
        raw.sample({estimator::from_microseconds(time_us), axis, 1e-6 * count(i, axis)});
    }
    raw.finish();
    write_summaries();
    config_path_ = directory_.path("table.toml");
    test::write_file(config_path_,
                     test::read_file(test::table_config()) + "\n[history]\ndirectory = \"h\"\n");
  }

  void write_summaries() {
    SummaryStore store(*config_.history);
    ASSERT_EQ(store.open(), "");
    SummaryBatch batch;
    batch.parameters.structure = "the table";
    batch.parameters.name = {"kx_1_y1", "kx_1_y2", "cx_1_y1"};
    batch.parameters.unit = {"N/m", "N/m", "N*s/m"};
    batch.parameters.kind = {0, 0, 2};
    batch.parameters.story = {1, 1, 1};
    for (int minute = 0; minute < 3; ++minute) {
      PeriodData data;
      data.start_us = kStart_us + minute * kSecond_us;
      data.windows = 4;
      data.last_us = data.start_us + 1;
      data.parameters.resize(3);
      for (int p = 0; p < 2; ++p) {
        ParameterData& d = data.parameters[static_cast<std::size_t>(p)];
        d.box = {10.0 + minute, 11.0 + minute, 12.0 + minute, 13.0 + minute};
        d.observable = 4;
        d.sum = 46.0 + 4 * minute;
        d.error_squares = 4 * 0.25;
        d.min = 10 + minute;
        d.max = 13 + minute;
      }
      batch.periods.push_back(data);
    }
    event_t event{};
    event.kind = "gap";
    event.state = 1;
    event.time_us = kStart_us;
    event.place = "F1-Y1";
    event.message = "they differ";
    batch.events.push_back(event);
    ASSERT_EQ(store.add(batch), "");
  }

  HistoryArguments arguments() const {
    HistoryArguments a;
    a.place = config_path_;
    return a;
  }
  struct Ran {
    int code;
    std::string out, problems;
  };
  static Ran run(const HistoryArguments& a) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int code = history(a);
    return {code, testing::internal::GetCapturedStdout(), testing::internal::GetCapturedStderr()};
  }

  const test::TemporaryDirectory directory_;
  Config config_;
  std::string config_path_;
};

TEST_F(HistoryCommand, PrintsAnOverviewWithoutArguments) {
  const Ran ran = run(arguments());
  EXPECT_EQ(ran.code, 0) << ran.problems;
  for (const char* part : {"the table: ", "raw samples", "from 2026-11-22T00:00:00Z", "3 logs",
                           "3 periods of 1 s", "kx_1_y1", "100.0%", "they differ"})
    EXPECT_NE(ran.out.find(part), std::string::npos) << part << "\n" << ran.out;
  EXPECT_LT(std::count(ran.out.begin(), ran.out.end(), '\n'), 40);
  HistoryArguments of_directory = arguments();
  of_directory.place = config_.history->directory;
  EXPECT_EQ(run(of_directory).out, ran.out);
}

TEST_F(HistoryCommand, WritesRequestedSummariesAsCsv) {
  HistoryArguments a = arguments();
  a.out = directory_.path("s.csv");
  a.from = "2026-11-22T00:00:01Z";
  a.parameters = {"k*_y1", "cx*"};
  const Ran ran = run(a);
  ASSERT_EQ(ran.code, 0) << ran.problems;
  EXPECT_EQ(test::read_file(a.out),
            "start,start_s,period_s,parameter,unit,windows,observable,mean,std_error,min,"
            "whisker_low,q1,median,q3,whisker_high,max,outliers\n"
            "2026-11-22T00:00:01Z,1795305601,1,kx_1_y1,N/m,4,4,12.5,0.5,11,11,11.5,12.5,13.5,14,14,"
            "0\n"
            "2026-11-22T00:00:02Z,1795305602,1,kx_1_y1,N/m,4,4,13.5,0.5,12,12,12.5,13.5,14.5,15,15,"
            "0\n"
            "2026-11-22T00:00:01Z,1795305601,1,cx_1_y1,N*s/m,4,0,,,,,,,,,,0\n"
            "2026-11-22T00:00:02Z,1795305602,1,cx_1_y1,N*s/m,4,0,,,,,,,,,,0\n");
}

TEST_F(HistoryCommand, WritesTheSameSummariesAsMat) {
  HistoryArguments a = arguments();
  a.out = directory_.path("s.mat");
  a.period_s = 2;
  ASSERT_EQ(run(a).code, 0);
  mat_t* file = Mat_Open(a.out.c_str(), MAT_ACC_RDONLY);
  ASSERT_NE(file, nullptr);
  EXPECT_EQ(Mat_GetVersion(file), MAT_FT_MAT5);
  matvar_t* median = Mat_VarRead(file, "median");
  ASSERT_NE(median, nullptr);
  EXPECT_EQ(median->dims[0], 2u);
  EXPECT_EQ(median->dims[1], 3u);
  const auto* values = static_cast<const double*>(median->data);
  EXPECT_EQ(values[0], 12.0);
  EXPECT_EQ(values[1], 13.5);
  EXPECT_TRUE(std::isnan(values[4]));
  Mat_VarFree(median);
  Mat_Close(file);
}

TEST_F(HistoryCommand, WritesRawSamplesAsALogWithConfiguredAddresses) {
  HistoryArguments a = arguments();
  a.raw = directory_.path("r.lcmlog");
  const Ran ran = run(a);
  ASSERT_EQ(ran.code, 0) << ran.problems;
  std::vector<drivers::Problem> problems;
  const auto record = drivers::read_accel_log(a.raw, "ACCEL", problems);
  ASSERT_TRUE(record) << problems.front().message;
  ASSERT_EQ(record->names.size(), 10u);
  EXPECT_EQ(record->names[2], "F1-Y1");
  drivers::LcmLogReader reader;
  ASSERT_TRUE(reader.open(a.raw));
  std::int64_t samples = 0, last = -1, jump = 0;
  for (drivers::LogEvent e; reader.next(e) == drivers::LogRead::event;) {
    const auto sample = drivers::decode_accel(e.data.data(), e.data.size());
    if (!sample) continue;
    ++samples;
    if (sample->node != 2) continue;
    const auto i = static_cast<int>((to_microseconds(sample->time) - kStart_us) / 10'000);
    EXPECT_NEAR(sample->accel_abs_mps2[0], 1e-6 * count(i, 2), 1e-12);
    jump = std::max(jump, sample->sequence - last);
    last = sample->sequence;
  }
  EXPECT_EQ(samples, (kInstants - (kLostTo - kLostFrom)) * kAxes);
  EXPECT_EQ(jump, kLostTo - kLostFrom + 1) << "the sequence skips lost samples";
}

TEST_F(HistoryCommand, KeepsTemperaturesInTheOrderOfTheLog) {
  HistoryArguments a = arguments();
  a.raw = directory_.path("r.lcmlog");
  const Ran ran = run(a);
  ASSERT_EQ(ran.code, 0) << ran.problems;
  drivers::LcmLogReader reader;
  ASSERT_TRUE(reader.open(a.raw));
  std::vector<double> degc;
  std::int64_t newest_us = 0;
  for (drivers::LogEvent e; reader.next(e) == drivers::LogRead::event;) {
    if (const auto sample = drivers::decode_accel(e.data.data(), e.data.size()))
      newest_us = to_microseconds(sample->time);
    if (e.channel != "TEMPERATURE") continue;
    const auto temperature = drivers::decoded<temperature_t>(e.data);
    ASSERT_TRUE(temperature);
    EXPECT_EQ(newest_us, temperature->time_us - kSecond_us / kRate_hz);
    degc.push_back(temperature->temperature_degc);
  }
  EXPECT_EQ(degc, (std::vector<double>{3, 6, 9})) << "the first came before every sample";
}

TEST_F(HistoryCommand, WritesRawSamplesAsACsvRecord) {
  HistoryArguments a = arguments();
  a.raw = directory_.path("r.csv");
  a.channels = {"F1-*", "base-x"};
  a.from = "2026-11-22T00:00:02Z";
  a.to = "2026-11-22T00:00:04Z";
  const Ran ran = run(a);
  ASSERT_EQ(ran.code, 0) << ran.problems;
  EXPECT_NE(ran.out.find("time zero is 2026-11-22T00:00:02Z"), std::string::npos) << ran.out;
  const std::string csv = test::read_file(a.raw);
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "time_s,base-x,F1-Y1,F1-Y2,F1-X1,F1-X2");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 201);
  a.raw = "-";
  EXPECT_EQ(run(a).out, csv) << "notes are no data";
}

TEST_F(HistoryCommand, WritesEveryCountAsMiniseed) {
  HistoryArguments a = arguments();
  a.raw = directory_.path("r.mseed");
  a.station = "TABLE";
  const Ran ran = run(a);
  ASSERT_EQ(ran.code, 0) << ran.problems;
  EXPECT_NE(ran.out.find("XX.TABLE.03.HN1 is F1-Y1"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("one count is 1e-06 m/s^2"), std::string::npos) << ran.out;
  MSRecord* record = nullptr;
  std::string path = a.raw;
  int seen = 0;
  while (ms_readmsr(&record, path.c_str(), 0, nullptr, nullptr, 1, 1, 0) == MS_NOERROR) {
    const int axis = std::atoi(record->location) - 1;
    EXPECT_EQ(record->samprate, kRate_hz);
    EXPECT_EQ(record->encoding, DE_STEIM2);
    const auto* counts = static_cast<const std::int32_t*>(record->datasamples);
    const auto first = static_cast<int>((record->starttime - kStart_us) / 10'000);
    for (int i = 0; i < record->numsamples; ++i, ++seen)
      ASSERT_EQ(counts[i], count(first + i, axis)) << axis << " " << first + i;
  }
  ms_readmsr(&record, nullptr, 0, nullptr, nullptr, 0, 0, 0);
  EXPECT_EQ(seen, (kInstants - (kLostTo - kLostFrom)) * kAxes);
}

TEST_F(HistoryCommand, ReadsItsMiniseedAsARecord) {
  HistoryArguments a = arguments();
  a.raw = directory_.path("r.mseed");
  ASSERT_EQ(run(a).code, 0);
  drivers::RecordOptions options;
  options.unit_mps2 = 1e-6;
  std::vector<drivers::Problem> problems;
  const auto record = drivers::read_record(a.raw, options, problems);
  for (const auto& p : problems) ADD_FAILURE() << p.where << ": " << p.message;
  ASSERT_TRUE(record);
  ASSERT_EQ(record->names.size(), std::size_t{kAxes});
  ASSERT_EQ(record->time_s.size(), std::size_t{kInstants});
  for (int i = 0; i < kInstants; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const bool lost = i >= kLostFrom && i < kLostTo;
    ASSERT_NEAR(record->time_s[at], static_cast<double>(kStart_us + i * 10'000L) / 1e6,
                lost ? 1e-6 : 0)
        << i;
    for (int axis = 0; axis < kAxes; ++axis) {
      const double value = record->accel_mps2[static_cast<std::size_t>(axis)][at];
      if (lost)
        ASSERT_TRUE(std::isnan(value)) << i;
      else
        ASSERT_EQ(value, count(i, axis) * 1e-6) << i << " " << axis;
    }
  }
}

TEST_F(HistoryCommand, ReportsEveryProblemAndWritesNothing) {
  HistoryArguments a = arguments();
  a.out = directory_.path("s.xlsx");
  a.raw = directory_.path("r.sac");
  a.from = "yesterday";
  a.period_s = 7;
  a.parameters = {"kx_1_y3"};
  a.network = "lower";
  const auto before = directory_.names();
  const Ran ran = run(a);
  EXPECT_EQ(ran.code, 2);
  for (const char* part :
       {"s.xlsx: the name for summaries", "r.sac: the name for raw samples",
        "--from: \"yesterday\"", "--period: no summaries of 7 s; there are 1, 2, 4 s",
        "there is no kx_1_y3; did you mean kx_1_y", "--network"})
    EXPECT_NE(ran.problems.find(part), std::string::npos) << part << "\n" << ran.problems;
  EXPECT_EQ(directory_.names(), before);
}

TEST_F(HistoryCommand, ReportsAFileThatItCannotCreate) {
  HistoryArguments a = arguments();
  a.raw = directory_.path("not there/r.mseed");
  EXPECT_EQ(run(a).code, 2);
  a.raw.clear();
  a.out = directory_.path("not there/s.csv");
  EXPECT_EQ(run(a).code, 2);
}

TEST_F(HistoryCommand, ReportsATimeWithoutSamples) {
  HistoryArguments a = arguments();
  a.raw = directory_.path("r.csv");
  a.to = "2020-01-01";
  const Ran ran = run(a);
  EXPECT_EQ(ran.code, 2);
  EXPECT_NE(ran.problems.find("no raw samples in that time"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(a.raw));
}

TEST_F(HistoryCommand, AcceptsAHistoryOfRawLogsOnly) {
  for (const char* ending : {"", "-wal", "-shm"})
    std::filesystem::remove(summary_file(config_.history->directory) + ending);
  HistoryArguments a;
  a.place = config_.history->directory;
  const Ran ran = run(a);
  EXPECT_EQ(ran.code, 0) << ran.problems;
  EXPECT_NE(ran.out.find("3 logs"), std::string::npos) << ran.out;
  a.raw = directory_.path("r.csv.gz");
  EXPECT_EQ(run(a).code, 0);
}

TEST_F(HistoryCommand, ReportsAMissingHistory) {
  HistoryArguments a;
  a.place = test::table_config();
  EXPECT_NE(run(a).problems.find("has no [history]"), std::string::npos);
  a.place = directory_.path("");
  EXPECT_NE(run(a).problems.find("does not exist"), std::string::npos);
  a.place = directory_.path("nowhere.toml");
  EXPECT_EQ(run(a).code, 2);
}

}  // namespace history_command_test
}  // namespace framewatch::daemon
