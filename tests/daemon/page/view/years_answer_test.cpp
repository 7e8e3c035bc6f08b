// SPDX-License-Identifier: MIT
// Tests what the page gets of a day, a month or a year of the history.
#include "daemon/page/view/years_answer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/page/view/years_desk.h"
#include "tests/support/history_fixture.h"
#include "tests/support/stored_summaries.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace years_answer_test {

using nlohmann::json;

constexpr std::int64_t kDay0_us = 20'000 * kDay_us;  // 2024-10-04
constexpr int kDays = 100;
constexpr double kPerDegc = -0.002;
constexpr std::chrono::seconds kPatience{60};

double degc(int day) {
  return 10 + 8 * std::sin(day / 9.0);
}

/// A hundred days with an hour each; two frames follow the temperature.
class YearsAnswers : public testing::Test {
 protected:
  YearsAnswers() : config_(test::table_with_history(directory_.path("h"))) {
    config_.history->summary_s = {3600};
    test::StoredSummaries stored(config_.history->directory);
    stored.together([&] {
      const auto a = stored.parameter("kx_1_y1"), b = stored.parameter("kx_1_y2"),
                 panel = stored.parameter("Gk_1_x1y1", "N/(rad*m)");
      for (int day = 0; day < kDays; ++day) {
        const std::int64_t at = kDay0_us + day * kDay_us + kDay_us / 2;
        stored.period(3600, at);
        for (const auto id : {a, b})
          stored.value(id, 3600, at, 2000 * std::exp(kPerDegc * degc(day)));
        stored.value(panel, 3600, at, 7);
        stored.weather("outside_degc", at, degc(day));
      }
      for (int i = 0; i < 250; ++i)
        stored.event(100 + i, "sensor", "F1-X2", kDay0_us + kDay_us + i, 1, "it is silent");
      stored.event(1, "lasting_loss", "kx_1_y1", kDay0_us + kDay_us, 2, "it lost <b>4 %</b>");
      stored.event(2, "lasting_loss", "kx_1_y1", kDay0_us - kDay_us, 2, "before");
      stored.note(1, "lasting_loss", kDay0_us + 2 * kDay_us, "brace \"loose\"");
    });
  }
  YearsAnswer answer(const YearsRequest& request, const WeatherModel& model = {}) const {
    SummaryQuery summaries;
    EXPECT_EQ(summaries.open(config_.history->directory), "");
    return answer_years(request, summaries, history_extent(summaries), model);
  }
  static YearsRequest of(const std::vector<std::string>& elements) {
    YearsRequest out;
    out.elements = elements;
    return out;
  }

  const test::TemporaryDirectory directory_;
  Config config_;
};

TEST(YearsRequests, AreReadOrRefusedWithTheReason) {
  std::string problem;
  const auto good =
      read_years_request("2024-10-04", "2024-10-05T00:00:00Z", "", "a,b", "elements", problem);
  ASSERT_TRUE(good) << problem;
  EXPECT_EQ(*good->from_us, kDay0_us);
  EXPECT_EQ(*good->to_us, kDay0_us + kDay_us);
  EXPECT_TRUE(good->only_elements);
  EXPECT_EQ(good->elements, (std::vector<std::string>{"a", "b"}));
  const auto last = read_years_request("", "", "365d", "", "", problem);
  ASSERT_TRUE(last) << problem;
  EXPECT_EQ(*last->last_us, 365 * kDay_us);
  const auto refused = [](const std::string& from, const std::string& to, const std::string& l,
                          const std::string& elements) {
    std::string why;
    EXPECT_FALSE(read_years_request(from, to, l, elements, "", why));
    return why;
  };
  EXPECT_EQ(refused("soon", "", "", ""),
            "from: \"soon\" is not a time such as 2026-11-21T23:15:00Z");
  EXPECT_EQ(refused("", "1e99", "", ""), "to: \"1e99\" is not a time such as 2026-11-21T23:15:00Z");
  EXPECT_EQ(refused("2024-10-05", "2024-10-05", "", ""), "from must be before to");
  EXPECT_EQ(refused("", "", "-1d", ""), "last: \"-1d\" is not a duration such as 90m, 2h or 365d");
  EXPECT_EQ(refused("2024-10-05", "", "1d", ""), "last cannot be combined with from or to");
  EXPECT_EQ(refused("", "", "", "a,b,c,d,e,f,g,h,i"), "elements: 9 at once; 8 are allowed");
}

TEST_F(YearsAnswers, HaveTheElementItsWeatherEventsAndNotes) {
  const YearsAnswer got = answer(of({"kx_1_y1"}));
  ASSERT_EQ(got.code, 200u) << got.text;
  const json j = json::parse(got.text);
  EXPECT_EQ(j["first_us"], kDay0_us + kDay_us / 2);
  EXPECT_EQ(j["step_s"], 86'400);
  EXPECT_EQ(j["points"], kDays);
  const json& e = j["elements"][0];
  EXPECT_EQ(e["name"], "kx_1_y1");
  EXPECT_EQ(e["unit"], "N/m");
  for (const char* list : {"q1", "median", "q3", "covered"}) EXPECT_EQ(e[list].size(), kDays);
  EXPECT_NEAR(e["median"][30], 2000 * std::exp(kPerDegc * degc(30)), 1e-3);
  EXPECT_NEAR(e["covered"][30], 1.0 / 24, 1e-4);
  EXPECT_TRUE(e["corrected"].is_null());
  EXPECT_EQ(j["model"]["state"], "fitting");
  EXPECT_EQ(j["weather"][0]["name"], "outside_degc");
  EXPECT_NEAR(j["weather"][0]["mean"][30], degc(30), 1e-4);
  // The answer has the gravest events of the span, and says how many there are in all.
  EXPECT_EQ(j["events"].size(), 200u);
  EXPECT_EQ(j["events_in_all"], 251);
  EXPECT_EQ(j["events"][0]["message"], "it lost <b>4 %</b>");
  ASSERT_EQ(j["notes"].size(), 1u);
  EXPECT_EQ(j["notes"][0]["comment"], "brace \"loose\"");
  EXPECT_EQ(j["notes"][0]["who"], "Ada");

  YearsRequest only = of({"kx_1_y1"});
  only.only_elements = true;
  const json less = json::parse(answer(only).text);
  EXPECT_EQ(less["elements"], j["elements"]);
  for (const char* list : {"weather", "events", "notes"}) EXPECT_TRUE(less[list].empty()) << list;
}

TEST_F(YearsAnswers, EndTheLastDaysWithAWholeStep) {
  YearsRequest r = of({"kx_1_y1"});
  r.last_us = 50 * kDay_us;
  const json j = json::parse(answer(r).text);
  EXPECT_EQ(j["to_us"], kDay0_us + kDays * kDay_us);
  EXPECT_EQ(j["from_us"], kDay0_us + (kDays - 50) * kDay_us);
  EXPECT_EQ(j["points"], 50);
}

TEST_F(YearsAnswers, RefuseAnElementThatIsNotThere) {
  const YearsAnswer got = answer(of({"kx_1_y3"}));
  EXPECT_EQ(got.code, 404u);
  EXPECT_NE(got.text.find("the history has no kx_1_y3, did you mean kx_1_y"), std::string::npos)
      << got.text;
}

TEST_F(YearsAnswers, SayThatThereIsNothing) {
  YearsRequest r = of({"kx_1_y1"});
  r.from_us = kDay0_us + 1000 * kDay_us;
  r.to_us = kDay0_us + 1001 * kDay_us;
  json j = json::parse(answer(r).text);
  EXPECT_EQ(j["period_s"], 0);
  EXPECT_TRUE(j["elements"][0]["median"][0].is_null());
  test::StoredSummaries(directory_.path("empty"));
  SummaryQuery summaries;
  ASSERT_EQ(summaries.open(directory_.path("empty")), "");
  const YearsAnswer got = answer_years(of({"kx_1_y1"}), summaries, history_extent(summaries), {});
  ASSERT_EQ(got.code, 200u) << got.text;
  j = json::parse(got.text);
  EXPECT_TRUE(j["first_us"].is_null());
  EXPECT_EQ(j["points"], 0);
}

TEST_F(YearsAnswers, AreCorrectedForTheWeatherAsSoonAsItsEffectIsLearned) {
  YearsDesk desk(config_);
  const auto asked = [&](const std::vector<std::string>& elements) {
    std::promise<YearsAnswer> told;
    EXPECT_TRUE(desk.ask(of(elements), [&](YearsAnswer a) { told.set_value(std::move(a)); }));
    const YearsAnswer got = told.get_future().get();
    EXPECT_EQ(got.code, 200u) << got.text;
    return json::parse(got.text);
  };
  json j;
  ASSERT_TRUE(test::comes_true(
      [&] {
        j = asked({"kx_1_y1", "Gk_1_x1y1"});
        return j["model"]["state"] == "ready";
      },
      kPatience));
  EXPECT_EQ(j["model"]["covariates"], json({"outside_degc"}));
  EXPECT_TRUE(j["elements"][1]["corrected"].is_null()) << "panels are not watched";
  const json &median = j["elements"][0]["median"], &corrected = j["elements"][0]["corrected"];
  const auto spread = [](const json& list) {
    double low = 1e9, high = 0;
    for (int day = 40; day + 1 < kDays; ++day) {
      low = std::min(low, list[day].get<double>());
      high = std::max(high, list[day].get<double>());
    }
    return high - low;
  };
  EXPECT_GT(spread(median), 50);
  EXPECT_LT(spread(corrected), 0.35 * spread(median));
}

TEST_F(YearsAnswers, HaveAnEndWhenTooManyWaitOrTheServerEnds) {
  std::promise<void> free;
  const std::future<void> freed = free.get_future();
  std::promise<void> blocked;
  std::vector<unsigned> codes;
  std::jthread later;
  {
    YearsDesk desk(config_);
    ASSERT_TRUE(desk.ask(of({}), [&](YearsAnswer) {
      blocked.set_value();
      freed.wait();
    }));
    blocked.get_future().wait();
    for (std::size_t i = 0; i < YearsDesk::kMost; ++i)
      EXPECT_TRUE(desk.ask(of({}), [&](YearsAnswer a) { codes.push_back(a.code); }));
    EXPECT_FALSE(desk.ask(of({}), [](YearsAnswer) { FAIL(); }));
    later = std::jthread([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      free.set_value();
    });
  }
  EXPECT_EQ(codes.size(), YearsDesk::kMost) << "each is answered once";
}

TEST(YearsDesks, SayWhyAHistoryCannotBeRead) {
  const test::TemporaryDirectory directory;
  const Config config = test::table_with_history(directory.path("none"));
  YearsDesk desk(config);
  std::promise<YearsAnswer> told;
  ASSERT_TRUE(desk.ask({}, [&](YearsAnswer a) { told.set_value(std::move(a)); }));
  const YearsAnswer got = told.get_future().get();
  EXPECT_EQ(got.code, 503u);
  EXPECT_EQ(got.text, "the history cannot be read: does not exist");
}

}  // namespace years_answer_test
}  // namespace framewatch::daemon
