// SPDX-License-Identifier: MIT
#include "daemon/page/view/stored_history.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <framewatch/accel_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/service_t.hpp>

#include "daemon/base/clocks.h"
#include "daemon/monitor/history/history.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/page/view/live_view.h"
#include "drivers/files/encoded.h"
#include "estimator/structure/parameter_table.h"
#include "tests/support/history_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace stored_history_test {

using nlohmann::json;

// Limits.
constexpr double kLost = 0.01;  // of the motion: samples not yet on the disk, and the mean's error

constexpr std::int64_t kStart_us = 1'795'305'600'000'000;  // 2026-11-22T00:00:00Z
constexpr std::int64_t kAge_s = 3600;
constexpr int kRate_hz = 100, kSeconds = 60,
              kSeen_s = 40;  // kSeen_s: after that, a parameter is not shown

/// A minute of the table on a moving base, as `framewatch run` stores it.
class StoredHistoryTest : public testing::Test {
 protected:
  StoredHistoryTest() : config_(test::table_with_history(directory_.path("h"))) {
    History history(config_);
    const estimator::ParameterTable table(config_.pipeline.structure);
    parameter_table_t names{};
    for (int p = 0; p < table.size(); ++p) {
      names.name.push_back(table[p].name);
      names.unit.push_back(table[p].unit);
      names.kind.push_back(static_cast<std::int32_t>(table[p].kind));
      names.story.push_back(table[p].story);
    }
    names.parameters = table.size();
    names.design.assign(names.name.size(), 1000.0);
    const auto tell = [&](const char* channel, const auto& message) {
      history.message(config_.lcm.prefix + channel, drivers::encoded(message));
    };
    tell("PARAMETERS", names);
    for (int i = 0; i < kRate_hz * kSeconds; ++i) {
      const std::int64_t time_us = kStart_us + i * kSecond_us / kRate_hz;
      const double moves = std::sin(2 * std::numbers::pi * 2 * i / kRate_hz);
      for (std::size_t a = 0; a < config_.pipeline.axes.size(); ++a)
        history.sample({estimator::from_microseconds(time_us), static_cast<int>(a), moves});
      window_estimate_t e{};
      e.window_end_us = time_us;
      e.status = 1;
      e.value.assign(names.name.size(), 1000.0);
      e.std_error.assign(names.name.size(), 2.0);
      e.reason.assign(names.name.size(), 0);
      if (i >= kRate_hz * kSeen_s) e.reason[0] = 2;
      e.parameters = names.parameters;
      e.snr.assign(names.name.size(), 1);
      e.prior_share = e.noise_share = e.snr;
      tell("ESTIMATE", e);
    }
    event_t event{};
    event.id = 3;
    event.time_us = event.since_us = kStart_us + 30 * kSecond_us;
    event.state = 1;
    event.severity = 2;
    event.kind = "stiffness_change";
    event.place = "kx_1_y1";
    event.message = "it changed";
    tell("EVENT", event);
  }
  LiveView view() const {
    return {config_, [](auto...) {}, [](const auto&...) { return CommandAnswer{}; }};
  }
  void restore(LiveView& view) const {
    std::vector<std::string> notes;
    view.restore(stored_history(config_, notes), kStart_us + (kSeconds + kAge_s) * kSecond_us);
    EXPECT_TRUE(notes.empty()) << notes.front();
    for (int flush = 0; flush < 20; ++flush) view.flush();  // a second
  }
  /// Returns the data that a viewer receives who joins now.
  static std::string joined(LiveView& view) {
    EventRing::Cursor cursor = view.join();
    std::string out(1 << 20, '\0');
    out.resize(view.read(cursor, out.data(), out.size()));
    return out;
  }
  static json event_of(const std::string& text, const std::string& name) {
    const std::string begin = "event: " + name + "\ndata: ";
    const std::size_t at = text.find(begin);
    return at == std::string::npos
               ? json()
               : json::parse(text.substr(at + begin.size(),
                                         text.find('\n', at + begin.size()) - at - begin.size()));
  }

  test::TemporaryDirectory directory_;
  Config config_;
};

TEST_F(StoredHistoryTest, ARestartedPageShowsEarlierHistory) {
  LiveView page = view();
  restore(page);
  const json history = json::parse(page.history_json());
  ASSERT_GT(history["rows"].size(), 10u);
  EXPECT_EQ(history["rows"].back()[5][1], 1000.0);
  EXPECT_NEAR(history["silent_s"].get<double>(), kAge_s, 5);
  EXPECT_FALSE(history["motion"].empty());
  const std::string seen = joined(page);
  const json last = event_of(seen, "last");
  ASSERT_EQ(last["index"][0], 0);
  EXPECT_NEAR(last["end_us"][0].get<double>() - static_cast<double>(kStart_us), 1e6 * kSeen_s, 1e6);
  EXPECT_NEAR(last["end_us"][1].get<double>() - static_cast<double>(kStart_us), 1e6 * kSeconds,
              2e6);
  EXPECT_GT(event_of(seen, "boxes")["count"][1], 0);
  const json answers = event_of(seen, "answers")["answers"];
  EXPECT_EQ(answers[0]["line"]["text"].get<std::string>().substr(0, 4), "Yes.");
  EXPECT_NE(answers[1]["line"]["text"].get<std::string>().find("no samples for 1 h"),
            std::string::npos)
      << answers[1];
  EXPECT_NE(answers[2]["line"]["text"].get<std::string>().find("A shake"), std::string::npos)
      << answers[2];
  EXPECT_NE(seen.find("it changed"), std::string::npos);
}

TEST_F(StoredHistoryTest, ShowsSensorsWhoseClockWasReset) {
  LiveView page = view();
  restore(page);
  accel_t sample{};
  for (int i = 0; i < 20 * kRate_hz; ++i) {
    sample.time_us = i * kSecond_us / kRate_hz;
    sample.sequence = i;
    for (sample.node = 0; sample.node < 10; ++sample.node) {
      const std::vector<std::uint8_t> bytes = drivers::encoded(sample);
      page.message("ACCEL", bytes.data(), bytes.size());
    }
    if (i % 5 == 0) page.flush();
  }
  EXPECT_LT(json::parse(page.history_json())["silent_s"].get<double>(), 2);
}

TEST_F(StoredHistoryTest, GivesThePeaksOfTheStoredMotion) {
  std::vector<std::string> notes;
  const StoredHistory stored = stored_history(config_, notes);
  const auto all = static_cast<double>(config_.pipeline.axes.size() * kRate_hz * kSeconds);
  EXPECT_GE(static_cast<double>(stored.samples.size()), (1 - kLost) * all);
  EXPECT_EQ(stored.events.size(), 1u);
}

TEST_F(StoredHistoryTest, ClosesEventsThatRunNoLongerRaises) {
  LiveView page = view();
  restore(page);
  service_t service{};
  service.time_us = kStart_us + 2 * kAge_s * kSecond_us;
  const std::vector<std::uint8_t> bytes = drivers::encoded(service);
  page.message(config_.lcm.prefix + "SERVICE", bytes.data(), bytes.size());
  for (int flush = 0; flush < 20; ++flush) page.flush();
  EXPECT_TRUE(event_of(joined(page), "answers")["findings"].empty());
}

TEST_F(StoredHistoryTest, ReportsAndSurvivesAForeignDatabase) {
  test::write_file(summary_file(config_.history->directory), "no database at all, but long enough");
  std::vector<std::string> notes;
  const StoredHistory stored = stored_history(config_, notes);
  EXPECT_TRUE(stored.estimates.empty());
  ASSERT_EQ(notes.size(), 1u);
}

}  // namespace stored_history_test
}  // namespace framewatch::daemon
