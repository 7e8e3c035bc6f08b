// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <utility>

#include <framewatch/accel_counts_t.hpp>
#include <framewatch/channel_table_t.hpp>

#include <gtest/gtest.h>

#include "daemon/config/channel_addresses.h"
#include "daemon/monitor/history/history_command.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_keeper.h"
#include "daemon/monitor/history/raw_history.h"
#include "daemon/tools/replay/counts_intake.h"
#include "daemon/tools/replay/replay_survey.h"
#include "daemon/tools/replay/stored_samples.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/count_block.h"
#include "drivers/lcm/message_check.h"
#include "tests/daemon/tools/replay/replay_fixture.h"
#include "tests/support/history_fixture.h"

namespace framewatch::daemon {
namespace raw_log_replay_test {

/// Returns the raw log that a history stores of the table's test.
class RawLogReplay : public test::ReplayFixture {
 protected:
  RawLogReplay() : config_(test::table_with_history(path("h"))) {
    config_.history->compress = false;
    HistoryKeeper keeper(*config_.history);
    RawHistory raw(config_, [&](auto log) { keeper.retire(std::move(log)); });
    struct Stored : EstimationListener {
      explicit Stored(RawHistory& raw) : raw_(raw) {}
      void on_sample(const estimator::AccelSample& s) override { raw_.sample(s); }
      RawHistory& raw_;
    } stored(raw);
    Estimation estimation(config_, {}, &stored);
    ReplaySurvey survey(config_, false);
    survey.feed(estimation);
    survey.add(log());
    EXPECT_TRUE(survey.problems().empty());
    raw.finish();
  }

  std::string raw_log() const { return raw_logs(raw_folder(path("h"))).at(0).path; }

  /// Writes the raw log with every message changed or, if `change` returns false, left out.
  template <typename Change>
  std::string changed(Change change) const {
    const std::string out = path("changed.lcmlog");
    test::rewrite(raw_log(), out, change);
    return out;
  }
  template <typename Change>
  std::string with_table(Change change) const {
    return changed([&](drivers::LogEvent& event) {
      if (event.channel != drivers::kCountsTableChannel) return true;
      auto table = *drivers::decoded<channel_table_t>(event.data);
      change(table);
      event.data = drivers::encoded(table);
      return true;
    });
  }
  template <typename Change>
  std::string with_blocks(Change change) const {
    return changed([&](drivers::LogEvent& event) {
      if (event.channel != drivers::kCountsChannel) return true;
      auto block = *drivers::decoded<accel_counts_t>(event.data);
      change(block);
      event.data = drivers::encoded(block);
      return true;
    });
  }
  /// Writes building.toml with this folder as its history. Returns a log of the history's raw
  /// samples.
  std::string exported(const std::string& folder) {
    const std::string config = path("building.toml");
    test::write_file(config, test::read_file(test::table_config()) + "\n[history]\ndirectory = \"" +
                                 path(folder) + "\"\n");
    testing::internal::CaptureStdout();
    HistoryArguments arguments;
    arguments.place = config;
    arguments.raw = path("exported.lcmlog");
    EXPECT_EQ(history(arguments), 0);
    testing::internal::GetCapturedStdout();
    return arguments.raw;
  }

  Config config_;
};

TEST_F(RawLogReplay, GivesTheEstimatesOfItsExportedLog) {
  const std::string config = path("building.toml"), exported = this->exported("h");
  for (const auto& [in, out] :
       {std::pair(raw_log(), path("a.lcmlog")), std::pair(exported, path("b.lcmlog"))})
    ASSERT_EQ(test::replay_of({in}, out, false, config).exit_code, 0);
  const auto of_raw = test::payloads(path("a.lcmlog"), "FRAMEWATCH_ESTIMATE");
  EXPECT_GT(of_raw.size(), 300u);
  EXPECT_EQ(of_raw, test::payloads(path("b.lcmlog"), "FRAMEWATCH_ESTIMATE"));
}

/// One node's clock leaps ten years ahead and back, then ten years back; at last all clocks go back
/// by 1,024 weeks.
TEST_F(RawLogReplay, ReadsWhatIsWrittenWhileClocksAreWrong) {
  constexpr std::int64_t kStart_us = 1'700'000'000'000'000, kStep_us = 10'000;
  constexpr std::int64_t kTenYears_us = 315'576'000'000'000, kWeeks_us = 1024 * 604'800'000'000;
  constexpr int kInstants = 2000, kOdd = 3, kAxes = 10;
  config_.history->directory = path("odd");
  config_.history->rotate_s = 2;
  {
    HistoryKeeper keeper(*config_.history);
    RawHistory raw(config_, [&](auto log) { keeper.retire(std::move(log)); });
    for (std::int64_t i = 0; i < kInstants; ++i)
      for (int axis = 0; axis < kAxes; ++axis) {
        std::int64_t time_us = kStart_us + kStep_us * i;
        if (axis == kOdd && i >= 300 && i < 600) time_us += kTenYears_us;
        if (axis == kOdd && i >= 700 && i < 900) time_us -= kTenYears_us;
        if (i >= 1200) time_us -= kWeeks_us;
        raw.sample({estimator::from_microseconds(time_us), axis, std::sin(0.1 * double(i))});
      }
    raw.finish();
  }
  const auto expect_readable = [&](const std::vector<std::string>& paths) {
    ReplaySurvey survey(config_, false);
    for (const std::string& log : paths) survey.add(log);
    survey.finish();
    EXPECT_EQ(survey.problems(), std::vector<std::string>());
    EXPECT_TRUE(survey.any_sample());
  };
  std::vector<std::string> logs;
  for (const RawLog& log : raw_logs(raw_folder(path("odd")))) logs.push_back(log.path);
  EXPECT_GT(logs.size(), 5u);
  expect_readable(logs);
  expect_readable({exported("odd")});
}

TEST_F(RawLogReplay, ReplaysAPart) {
  ReplaySurvey whole(config_, false);
  whole.add(raw_log());
  ReplaySurvey part(config_, false, {2, 5});
  part.add(raw_log());
  EXPECT_NEAR(whole.measured_seconds(), 12, 0.05);
  EXPECT_NEAR(part.measured_seconds(), 3, 0.05);
  const std::int64_t zero_us = whole.first_us() + 4'000'000;
  ReplaySurvey from_a_time(config_, false, {0, 1, zero_us});
  from_a_time.add(raw_log());
  EXPECT_EQ(from_a_time.first_us(), zero_us);
  ReplaySurvey beyond(config_, false, {0, 1, zero_us + 100'000'000});
  beyond.add(raw_log());
  EXPECT_TRUE(beyond.problems().empty());
  EXPECT_FALSE(beyond.any_sample());
}

TEST_F(RawLogReplay, EveryReaderOfStoredSamplesReadsIt) {
  std::int64_t samples = 0;
  drivers::AccelIntake intake(wanted_axes(config_), [&](const estimator::AccelSample&) {});
  const std::string problem =
      push_stored_samples(config_, {raw_log(), false, {}, {}}, intake,
                          [&](const estimator::AccelSample&) { ++samples; });
  EXPECT_EQ(problem, "");
  EXPECT_EQ(samples, std::ssize(test::raw_counts(path("h"))));
  EXPECT_GT(samples, 11 * 100 * std::ssize(config_.pipeline.axes));
}

TEST_F(RawLogReplay, MissingCountsGiveNoValue) {
  CountsIntake intake({"a", "b"});
  const auto table = drivers::count_table({"b", "other"}, 100, 0);
  std::vector<estimator::AccelSample> seen;
  const auto sink = [&](const estimator::AccelSample& s) { seen.push_back(s); };
  EXPECT_EQ(intake.message(drivers::kCountsTableChannel, table, sink),
            drivers::IntakeResult::table);
  drivers::CountBlock block(0.5);
  block.add({estimator::from_microseconds(7), 0, 1.5});
  block.add({estimator::from_microseconds(8), 1, 9});
  block.add({estimator::from_microseconds(9), 0, std::numeric_limits<double>::quiet_NaN()});
  EXPECT_EQ(intake.message(drivers::kCountsChannel, block.encode(), sink),
            drivers::IntakeResult::samples);
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].axis, 1);
  EXPECT_EQ(seen[0].accel, 1.5);
  EXPECT_EQ(to_microseconds(seen[0].time), 7);
  EXPECT_TRUE(std::isnan(seen[1].accel));
  EXPECT_EQ(intake.unknown(), std::vector<std::string>{"other"});
  EXPECT_EQ(intake.missing(), std::vector<std::string>{"a"});
}

TEST_F(RawLogReplay, RefusesALogWithoutItsTable) {
  expect_refused(
      changed([](drivers::LogEvent& e) { return e.channel != drivers::kCountsTableChannel; }),
      "the first: COUNTS: no channel table before it");
}

TEST_F(RawLogReplay, RefusesOtherChannelsAndNamesThem) {
  expect_refused(with_table([](channel_table_t& table) {
                   for (std::string& name : table.name) name = "x" + name;
                 }),
                 "no channel is named like one of");
}

TEST_F(RawLogReplay, RefusesAnotherRate) {
  expect_refused(with_table([](channel_table_t& table) { table.rate_hz = 200; }), "sampled at 200");
}

TEST_F(RawLogReplay, RefusesMalformedBlocksAndSalvagesWithoutThem) {
  int block = 0;
  const std::string log = changed([&](drivers::LogEvent& event) {
    if (event.channel == drivers::kCountsChannel && ++block == 3) event.data.resize(20);
    return true;
  });
  expect_refused(log, "1 messages are not valid in a raw log, the first: COUNTS: ");
  EXPECT_EQ(test::salvage_of(log, path("out.lcmlog")).exit_code, 0);
}

TEST_F(RawLogReplay, RefusesAnInvalidResolution) {
  for (const double bad : {0.0, -1e-6, std::numeric_limits<double>::infinity(),
                           std::numeric_limits<double>::quiet_NaN()})
    expect_refused(with_blocks([&](accel_counts_t& b) { b.resolution_mps2 = bad; }),
                   "messages are not valid in a raw log");
}

TEST_F(RawLogReplay, IgnoresTimesAndChannelsOutOfRange) {
  const std::string log = with_blocks([](accel_counts_t& b) {
    b.time_us = INT64_MAX;
    for (std::size_t i = 0; i < b.channel.size(); ++i)
      b.channel[i] = static_cast<std::int16_t>(i % 2 == 0 ? -1 : 32767);
  });
  expect_refused(log, "no channel is named like one of");
}

}  // namespace raw_log_replay_test
}  // namespace framewatch::daemon
