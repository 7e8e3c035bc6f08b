// SPDX-License-Identifier: MIT
#include "daemon/page/view/page_history.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <framewatch/event_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/watch_t.hpp>

#include "estimator/numeric/nan.h"
#include "estimator/structure/parameter_table.h"
#include "tests/daemon/page/web/served.h"

namespace framewatch::daemon {
namespace page_history_test {

using nlohmann::json;
using test::ask, test::request, test::Served;

window_estimate_t estimate_at(std::int64_t end_us, const std::vector<double>& value) {
  window_estimate_t e{};
  e.window_end_us = end_us;
  e.status = 1;
  e.parameters = static_cast<std::int32_t>(value.size());
  e.value = value;
  for (const double v : value) {
    e.std_error.push_back(0.01 * v);
    e.reason.push_back(std::isnan(v) ? 2 : 0);
  }
  e.snr.assign(value.size(), 1);
  e.prior_share = e.noise_share = e.snr;
  return e;
}

void add_boxes(window_estimate_t& e) {
  e.boxplots = e.parameters;
  e.boxplot_windows = 1000;
  e.q1 = e.median = e.q3 = e.whisker_low = e.whisker_high = e.value;
  e.outliers.assign(e.value.size(), 1);
  for (const double v : e.value) e.boxplot_count.push_back(std::isnan(v) ? 0 : 500);
}

class PageHistoryTest : public ::testing::Test {
 protected:
  Config config_ = test::good(test::kGoodConfig);
  PageHistory history_{config_.pipeline};
};

TEST_F(PageHistoryTest, KeepsTwoWindowsASecondForFiveMinutes) {
  const std::int64_t first_us = 1'700'000'000'000'000;
  for (std::int64_t i = 0; i < 60'000; ++i)
    history_.estimate(estimate_at(first_us + 10'000 * i, {1.0 + static_cast<double>(i), 2}));
  const json rows = json::parse(history_.json(7.5))["rows"];
  EXPECT_NEAR(static_cast<double>(rows.size()), PageHistory::kMost_s / PageHistory::kEvery_s, 2);
  EXPECT_NEAR(1e-6 * (rows.back()[0].get<double>() - rows.front()[0].get<double>()),
              PageHistory::kMost_s, 1);
  EXPECT_EQ(json::parse(history_.json(7.5))["silent_s"], 7.5);
}

TEST_F(PageHistoryTest, AWindowThatComesLateFillsItsRow) {
  for (std::int64_t i = 0; i < 4; ++i)
    history_.estimate(estimate_at(500'000 * i, {estimator::kNaN, 2}));
  EXPECT_TRUE(history_.late(estimate_at(500'000, {7, 2})));
  EXPECT_FALSE(history_.late(estimate_at(510'000, {8, 2})));  // between two rows
  EXPECT_FALSE(history_.late(estimate_at(9'000'000, {8, 2})));
  EXPECT_FALSE(history_.late(estimate_at(500'000, {8})));  // of another building
  const json rows = json::parse(history_.json(0))["rows"];
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[1][5], json({7, 2}));
  EXPECT_TRUE(rows[2][5][0].is_null());
}

TEST_F(PageHistoryTest, IsBoundedForAnyBuilding) {
  const std::vector<double> many(2000, 1.0);
  for (std::int64_t i = 0; i < 600; ++i) history_.estimate(estimate_at(1'000'000 * i, many));
  EXPECT_EQ(json::parse(history_.json(0))["rows"].size(), PageHistory::kMaxValues / many.size());
  for (std::int64_t i = 0; i < 6000; ++i) history_.motion("{}", i, 20);
  EXPECT_LE(json::parse(history_.json(0))["motion"].size(), 20 * PageHistory::kMotion_s + 1);
}

TEST_F(PageHistoryTest, KeepsTheLastValueAndBoxOfAnElement) {
  window_estimate_t e = estimate_at(5'000'000, {10, 20});
  add_boxes(e);
  history_.estimate(e);
  EXPECT_TRUE(json::parse(history_.last_json())["index"].empty());
  e = estimate_at(9'000'000, {11, estimator::kNaN});
  add_boxes(e);
  e.boxplot_count[1] = 3;  // of a thousand windows: the last one with a value
  e.median[1] = 25;
  history_.estimate(e);
  const json last = json::parse(history_.last_json());
  EXPECT_EQ(last["index"], json({1}));
  EXPECT_EQ(last["value"], json({20}));
  EXPECT_EQ(last["end_us"], json({5'000'000}));
  const json boxes = json::parse(history_.boxes_json());
  EXPECT_EQ(boxes["median"], json({11, 20}));
  EXPECT_EQ(boxes["count"], json({500, 500}));
}

/// The estimator may hold values from before this process started.
TEST_F(PageHistoryTest, ShowsHeldValuesAsLastValue) {
  window_estimate_t e = estimate_at(9'000'000, {estimator::kNaN, estimator::kNaN});
  e.held = 1;
  e.held_index = {1};
  e.held_value = {30};
  e.held_std_error = {3};
  e.held_end_us = {4'000'000};
  history_.estimate(e);
  const json last = json::parse(history_.last_json());
  EXPECT_EQ(last["index"], json({1}));
  EXPECT_EQ(last["end_us"], json({4'000'000}));
}

class Answering : public Served {
 protected:
  void parameters() {
    const estimator::ParameterTable names(config_.pipeline.structure);
    parameter_table_t table{};
    for (int p = 0; p < names.size(); ++p) {
      table.name.push_back(names[p].name);
      table.unit.push_back(names[p].unit);
      table.kind.push_back(static_cast<std::int32_t>(names[p].kind));
      table.story.push_back(names[p].story);
      table.design.push_back(1);
    }
    table.parameters = names.size();
    send("FRAMEWATCH_PARAMETERS", table);
  }
  std::size_t view_parameters() const {
    return static_cast<std::size_t>(estimator::ParameterTable(config_.pipeline.structure).size());
  }
  void second() {
    for (int i = 0; i < 20; ++i) view_.flush();
  }
  /// Returns the data of the last event with this name that a new viewer receives.
  json joined(const std::string& name) {
    EventRing::Cursor cursor = view_.join();
    std::string text(1'000'000, '\0');
    text.resize(view_.read(cursor, text.data(), text.size()));
    const std::string head = "event: " + name + "\ndata: ";
    const std::size_t at = text.rfind(head);
    if (at == std::string::npos) return nullptr;
    const std::size_t from = at + head.size();
    return json::parse(text.substr(from, text.find('\n', from) - from));
  }
};

TEST_F(Answering, TellsThePageOfLateWindows) {
  parameters();
  const std::size_t n = view_parameters();
  send("FRAMEWATCH_ESTIMATE", estimate_at(500'000, std::vector<double>(n, estimator::kNaN)));
  EventRing::Cursor cursor = view_.join();
  send("FRAMEWATCH_ESTIMATE_LATE", estimate_at(500'000, std::vector<double>(n, 7)));
  second();
  std::string text(1'000'000, '\0');
  text.resize(view_.read(cursor, text.data(), text.size()));
  EXPECT_NE(text.find("event: late\n"), std::string::npos);
  EXPECT_EQ(json::parse(view_.history_json())["rows"][0][5][0], 7);
}

TEST_F(Answering, SendsAnswersFindingsAndHistoryToALateViewer) {
  parameters();
  event_t damage{};
  damage.id = 3;
  damage.state = 1;
  damage.severity = 2;
  damage.kind = "stiffness_change";
  damage.place = "kx_1_y2";
  damage.value = -14.8;
  damage.std_error = 0.4;
  damage.unit = "%";
  send("FRAMEWATCH_EVENT", damage);
  event_t gap = damage;
  gap.id = 4;
  gap.severity = 1;
  gap.kind = "gap";
  gap.place = "F1-Y1";
  gap.message = "they differ";
  send("FRAMEWATCH_EVENT", gap);
  send("FRAMEWATCH_ESTIMATE", estimate_at(5'000'000, std::vector<double>(8, 1.0)));
  second();
  json told = joined("answers");
  ASSERT_EQ(told["answers"].size(), 4u);
  ASSERT_EQ(told["findings"].size(), 2u);
  EXPECT_EQ(told["findings"][0]["place"], "kx_1_y2");  // the gap has not replaced it
  EXPECT_NEAR(told["findings"][0]["ratio"].get<double>(), -0.148, 1e-12);
  EXPECT_NE(told["answers"][0]["line"]["text"].get<std::string>().find("14.8 %"),
            std::string::npos);
  damage.state = 2;  // it becomes more exact
  damage.value = -15.02;
  damage.std_error = 0.05;
  send("FRAMEWATCH_EVENT", damage);
  second();
  told = joined("answers");
  EXPECT_NE(told["answers"][0]["line"]["text"].get<std::string>().find("15.02 %"),
            std::string::npos);
  EXPECT_EQ(view_.acknowledge(3, "me"), 0);
  second();
  told = joined("answers");
  EXPECT_EQ(told["findings"][0]["acknowledged"], true);
  damage.state = 0;
  send("FRAMEWATCH_EVENT", damage);
  second();
  EXPECT_EQ(joined("answers")["findings"].size(), 1u);
  const std::string history = ask(server_.port(), request("GET /history.json"));
  EXPECT_NE(history.find("\"rows\":[[5000000,1,"), std::string::npos) << history;
}

/// With [watch], the page uses the baseline of `framewatch run`.
TEST(WatchedPage, UsesTheBaselineOfRun) {
  const Config config = test::good(std::string(test::kGoodConfig) + "[watch]\n");
  LiveView view(
      config, [](std::int64_t, const std::string&, const std::vector<std::uint8_t>&) {},
      [](const std::string&, const CommandPacket&) {
        return CommandAnswer{true, "", {}};
      });
  EXPECT_FALSE(view.renew_baseline());
  const estimator::ParameterTable names(config.pipeline.structure);
  parameter_table_t table{};
  watch_t watch{};
  for (int p = 0; p < names.size(); ++p) {
    table.name.push_back(names[p].name);
    table.unit.push_back(names[p].unit);
    table.kind.push_back(0);
    table.story.push_back(1);
    table.design.push_back(1);
    watch.watched.push_back(p < 4 ? 1 : 0);
    watch.baseline.push_back(p < 4 ? 20e3 + p : estimator::kNaN);
    for (auto* list : {&watch.baseline_std_error, &watch.baseline_degc, &watch.quiet_baseline,
                       &watch.quiet_std_error, &watch.per_degc, &watch.per_degc_std_error,
                       &watch.per_log_amplitude, &watch.per_log_amplitude_std_error})
      list->push_back(estimator::kNaN);
  }
  table.parameters = watch.parameters = names.size();
  const auto send = [&](const std::string& channel, const auto& message) {
    const std::vector<std::uint8_t> bytes = drivers::encoded(message);
    view.message(channel, bytes.data(), bytes.size());
  };
  send("FRAMEWATCH_PARAMETERS", table);
  send("FRAMEWATCH_WATCH", watch);
  for (int i = 0; i < 20; ++i) view.flush();
  EventRing::Cursor cursor = view.join();
  std::string text(100'000, '\0');
  text.resize(view.read(cursor, text.data(), text.size()));
  EXPECT_NE(text.find("event: baseline\ndata: {\"value\":[20000,20001,20002,20003,null"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("None of 4 elements differs"), std::string::npos) << text;
}

}  // namespace page_history_test
}  // namespace framewatch::daemon
