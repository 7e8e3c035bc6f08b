// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/watch_t.hpp>

#include "drivers/files/encoded.h"
#include "fleet/store/fleet_store.h"
#include "fleet/view/building_view.h"
#include "fleet/view/earthquake_view.h"
#include "fleet/view/overview.h"
#include "tests/fleet/support/own_postgres.h"

namespace framewatch::fleet {
namespace views_test {

using nlohmann::json;

// Limits.
constexpr double kLoss = -0.15, kLossWithin = 0.02;

constexpr std::int64_t kQuake_us = 1'795'305'600'000'000;  // 2026-11-22T00:00:00Z
constexpr std::int64_t kMinute_us = 60'000'000;
const std::string kConfig(64, 'a');

event_t event(std::int64_t id, const std::string& kind, std::int32_t severity) {
  event_t e{};
  e.kind = kind;
  e.id = id;
  e.time_us = kQuake_us + id;
  e.since_us = kQuake_us + id;
  e.state = 1;
  e.severity = severity;
  e.place = "kx_1_y1";
  e.message = "message <b>" + std::to_string(id) + "</b>";
  return e;
}

ReceivedNewest heartbeat(const std::string& building, const std::vector<event_t>& raised = {}) {
  service_t s{};
  s.version = "1.0";
  s.raised = static_cast<std::int32_t>(raised.size());
  for (const event_t& e : raised) {
    s.event_id.push_back(e.id);
    s.event_since_us.push_back(e.since_us);
    s.event_severity.push_back(e.severity);
    s.event_kind.push_back(e.kind);
    s.event_place.push_back(e.place);
    s.event_message.push_back(e.message);
  }
  return {building, "service", "service_t", drivers::encoded(s)};
}

ReceivedNewest acknowledged(const std::string& building, std::int64_t id, const std::string& who) {
  acknowledged_t a{};
  a.events = 1;
  a.id = {id};
  a.kind = {"gap"};
  a.place = {"kx_1_y1"};
  a.since_us = {kQuake_us};
  a.who = {who};
  a.comment = {""};
  return {building, "acknowledged", "acknowledged_t", drivers::encoded(a)};
}

parameter_table_t parameters() {
  parameter_table_t t{};
  t.structure = "a tower";
  t.config_sha256 = kConfig;
  t.parameters = 3;
  t.name = {"kx_1_y1", "kx_2_y1", "cx_1_y1"};
  t.unit = {"N/m", "N/m", "N*s/m"};
  t.kind = {0, 0, 2};
  t.story = {1, 2, 1};
  t.design = {100, 100, 1};
  return t;
}

/// A period with these stiffnesses; NaN: not observable.
ReceivedSummary period(const std::string& building, std::int32_t length_s, std::int64_t start_us,
                       float first, float second) {
  summary_t s{};
  s.start_us = start_us;
  s.period_s = length_s;
  s.windows = 50;
  s.config_sha256 = kConfig;
  s.observable = {std::isnan(first) ? 0 : 50, std::isnan(second) ? 0 : 50, 50};
  s.median = {first, second, 1};
  s.q1 = {first - 1, second - 1, 1};
  s.q3 = {first + 1, second + 1, 1};
  s.std_error = {1, 1, 1};
  return {building, s};
}

class Views : public OnPostgres {
 protected:
  void store(const FleetBatch& batch) {
    FleetStore store;
    ASSERT_EQ(store.open(where_), "");
    ASSERT_EQ(store.add(batch), "");
  }
};

const json& of(const json& list, const std::string& name) {
  static const json none;
  for (const json& one : list)
    if (one.at("name") == name) return one;
  return none;
}

TEST_F(Views, OverviewCombinesHeartbeatsAndLaterEvents) {
  event_t over = event(5, "gap", 1);
  over.state = 0;
  FleetBatch heartbeats, events;
  heartbeats.newest = {heartbeat("well"),
                       heartbeat("damaged", {event(5, "gap", 1)}),
                       heartbeat("silent"),
                       heartbeat("gone"),
                       heartbeat("known", {event(8, "gap", 2)}),
                       heartbeat("told", {event(7, "gap", 2)}),
                       acknowledged("told", 7, "bob")};
  events.events = {{"damaged", event(9, "stiffness_change", 2)}, {"damaged", over}};
  store(heartbeats);
  store(events);
  ASSERT_TRUE(look_.execute(
      "UPDATE newest SET came = now() - interval '1 hour' WHERE building ="
      " (SELECT id FROM building WHERE name = 'silent');"
      "UPDATE building SET retired = true WHERE name = 'gone';"
      "UPDATE building SET latitude = 34.5, longitude = 135 WHERE name = 'well';"
      "INSERT INTO journal (request, who, verb, content) VALUES ('r', 'alice', 'acknowledge',"
      " '{\"id\":8}');"
      "INSERT INTO journal_answer SELECT 'r', id, now(), true, '' FROM building WHERE name = "
      "'known'"))
      << look_.error();
  const Overview overview = read_overview(look_);
  ASSERT_EQ(overview.problem, "");
  const json d = json::parse(overview_json(overview));
  ASSERT_EQ(d["buildings"].size(), 5u);
  EXPECT_EQ(d["buildings"][0]["name"], "damaged");
  EXPECT_EQ(of(d["buildings"], "damaged")["urgency"], "alarm");
  EXPECT_EQ(of(d["buildings"], "damaged")["raised"], 1);
  EXPECT_EQ(of(d["buildings"], "silent")["urgency"], "silent");
  EXPECT_EQ(of(d["buildings"], "known")["urgency"], "known");
  EXPECT_EQ(of(d["buildings"], "told")["urgency"], "known");  // acknowledged in the building
  EXPECT_EQ(json::parse(building_json(look_, "told"))["raised"][0]["known_to"], "bob");
  EXPECT_EQ(json::parse(building_json(look_, "known"))["raised"][0]["known_to"], "alice");
  EXPECT_EQ(of(d["buildings"], "well")["latitude"], 34.5);
  EXPECT_EQ(d["counts"]["well"], 1);

  const json one = json::parse(building_json(look_, "damaged"));
  EXPECT_EQ(one["raised"][0]["id"], 9);
  EXPECT_EQ(one["raised"][0]["known"], false);
  EXPECT_EQ(one["process"]["version"], "1.0");
  EXPECT_EQ(one["events"].size(), 2u);
  EXPECT_EQ(json::parse(building_json(look_, "nobody"))["problem"], "no such building");
}

TEST_F(Views, RawSamplesAreCompleteOrSayWhyNot) {
  FleetBatch batch;
  batch.newest = {heartbeat("tower")};
  batch.pieces = {{"tower", "whole", "whole.mseed", 1, 2, {0xff, 4}},
                  {"tower", "whole", "whole.mseed", 0, 2, {1, 2}},
                  {"tower", "part", "part.mseed", 1, 2, {3, 4}},
                  {"tower", "none", "none.mseed", 0, 0, {'n', 'o'}}};
  store(batch);
  std::string why;
  const auto whole = read_fetched(look_, "tower", "whole", why);
  ASSERT_TRUE(whole) << why;
  EXPECT_EQ(whole->miniseed, (Bytes{1, 2, 0xff, 4}));
  EXPECT_EQ(whole->file, "whole.mseed");
  EXPECT_FALSE(read_fetched(look_, "tower", "part", why));
  EXPECT_EQ(why, "1 of 2 pieces have come");
  EXPECT_FALSE(read_fetched(look_, "tower", "none", why));
  EXPECT_EQ(why, "no samples: no");
  EXPECT_FALSE(read_fetched(look_, "tower", "other", why));
  EXPECT_EQ(why, "no piece has come yet");
  const json all = json::parse(building_json(look_, "tower"))["stretches"];
  ASSERT_EQ(all.size(), 3u);
  for (const json& one : all) EXPECT_EQ(one["problem"], one["request"] == "none" ? "no" : "");
}

TEST_F(Views, ShowAParameterOverTime) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  FleetBatch batch;
  watch_t watch{};
  watch.parameters = 3;
  watch.watched.assign(3, 1);
  for (auto* list :
       {&watch.baseline, &watch.baseline_std_error, &watch.baseline_degc, &watch.quiet_baseline,
        &watch.quiet_std_error, &watch.per_degc, &watch.per_degc_std_error,
        &watch.per_log_amplitude, &watch.per_log_amplitude_std_error})
    list->assign(3, 100);
  batch.newest = {heartbeat("tower"),
                  {"tower", "watch", "watch_t", drivers::encoded(watch)},
                  {"tower", "parameters", "parameter_table_t", drivers::encoded(parameters())}};
  batch.parameters = {{"tower", parameters()}};
  for (int i = 0; i < 3000; ++i)
    batch.summaries.push_back(period("tower", 60, kQuake_us + i * kMinute_us, i == 2999 ? none : 90,
                                     static_cast<float>(i)));
  store(batch);
  const json building = json::parse(building_json(look_, "tower"));
  EXPECT_EQ(building["structure"], "a tower");
  EXPECT_EQ(building["parameters"][0]["baseline"], 100);
  EXPECT_EQ(building["parameters"][0]["median"], 90);
  EXPECT_EQ(building["parameters"][0]["observed_us"], kQuake_us + 2998 * kMinute_us);
  EXPECT_EQ(building["parameters"][1]["observed_us"], kQuake_us + 2999 * kMinute_us);
  const json all = json::parse(
      series_json(look_, {"tower", "kx_2_y1", kQuake_us, kQuake_us + 3000 * kMinute_us, 0}));
  EXPECT_EQ(all["period_s"], 60);
  EXPECT_EQ(all["of"], 3);
  ASSERT_EQ(all["median"].size(), 1000u);
  EXPECT_EQ(all["median"][1], 4);
  EXPECT_EQ(all["q1"][1], 2);
  EXPECT_EQ(all["q3"][1], 6);
  const json end =
      json::parse(series_json(look_, {"tower", "kx_1_y1", kQuake_us + 2998 * kMinute_us,
                                      kQuake_us + 3000 * kMinute_us, 60}));
  EXPECT_EQ(end["median"], json({90, nullptr}));
  EXPECT_TRUE(json::parse(series_json(look_, {"tower", "none", 0, kQuake_us, 60}))["t_us"].empty());
}

TEST_F(Views, AnEarthquakeSortsByTheLargestSignificantLoss) {
  const float none = std::numeric_limits<float>::quiet_NaN();
  FleetBatch batch;
  for (const char* name : {"damaged", "slightly", "whole", "hidden", "quiet", "tens"}) {
    batch.parameters.push_back({name, parameters()});
    batch.events.push_back({name, event(1, "strong_motion", 0)});
  }
  for (int i = -10; i < 14; ++i) {
    const std::int64_t start_us = kQuake_us + i * kMinute_us;
    const bool after = i >= 0;
    const auto noise = static_cast<float>(i % 3 - 1);
    batch.summaries.push_back(period("damaged", 60, start_us, after ? 85 : 100, 100 + noise));
    batch.summaries.push_back(period("slightly", 60, start_us, after ? 99.7F : 100, 100 + noise));
    batch.summaries.push_back(period("whole", 60, start_us, 100 + noise, after ? none : 100));
    batch.summaries.push_back(period("hidden", 60, start_us, after ? 100 : none, none));
    if (i % 2 == 0)
      batch.summaries.push_back(
          period("tens", 600, kQuake_us + i / 2 * 10 * kMinute_us, after ? 70 : 100, 100));
  }
  store(batch);
  const json d = json::parse(earthquake_json(look_, {kQuake_us, ""}));
  ASSERT_FALSE(d.contains("problem")) << d;
  std::vector<std::string> order;
  for (const json& b : d["buildings"]) order.push_back(b["name"]);
  EXPECT_EQ(order,
            (std::vector<std::string>{"tens", "damaged", "slightly", "whole", "hidden", "quiet"}));
  const json& damaged = of(d["buildings"], "damaged");
  EXPECT_EQ(damaged["result"], "loss");
  EXPECT_EQ(damaged["worst"]["parameter"], "kx_1_y1");
  EXPECT_NEAR(damaged["worst"]["ratio"].get<double>(), kLoss, kLossWithin);
  EXPECT_EQ(damaged["before"], 10);
  EXPECT_EQ(damaged["after"], 10);
  EXPECT_EQ(of(d["buildings"], "slightly")["result"], "none");
  EXPECT_EQ(of(d["buildings"], "whole")["not_observable"], json({"kx_2_y1"}));
  EXPECT_EQ(of(d["buildings"], "hidden")["result"], "not_observable");
  EXPECT_EQ(of(d["buildings"], "quiet")["result"], "nothing");
  EXPECT_EQ(of(d["buildings"], "tens")["period_s"], 600);
  const json one = json::parse(earthquake_json(look_, {kQuake_us, "damaged"}));
  EXPECT_EQ(one["buildings"][0]["parameters"].size(), 2u);
  const json list = json::parse(earthquakes_json(look_, 3660));
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0]["buildings"], 6);
  EXPECT_EQ(list[0]["time_us"], kQuake_us + 1);
}

}  // namespace views_test
}  // namespace framewatch::fleet
