// SPDX-License-Identifier: MIT
// Tests what the page's server answers about the history, and that nothing waits for it.
#include <algorithm>
#include <cstdint>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "tests/daemon/page/web/served.h"
#include "tests/support/stored_summaries.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace web_years_test {

using nlohmann::json;
using test::ask, test::request, test::Served;

constexpr std::int64_t kDay0_us = 20'000 * kDay_us;
constexpr int kHours = 2000, kAtOnce = 40;

class HasHistory {
 protected:
  HasHistory() {
    test::StoredSummaries stored(directory_.path("h"));
    stored.together([&] {
      const auto id = stored.parameter("kx_1_y1");
      for (int hour = 0; hour < kHours; ++hour) {
        const std::int64_t at = kDay0_us + hour * 3600 * kSecond_us;
        stored.period(3600, at);
        stored.value(id, 3600, at, 1000 + hour);
      }
    });
  }
  const test::TemporaryDirectory directory_;
};

class ServedYears : HasHistory, public Served {
 protected:
  ServedYears()
      : Served(settings(), test::kGoodConfig +
                               ("\n[history]\ndirectory = \"" + directory_.path("h") + "\"\n")) {}
};

std::string body_of(const std::string& answer) {
  return answer.substr(std::min(answer.size(), answer.find("\r\n\r\n") + 4));
}

TEST_F(ServedYears, AreAnsweredOrRefusedWithTheReason) {
  const auto asked = [&](const std::string& query) {
    return ask(server_.port(), request("GET /years.json" + query));
  };
  const std::string good = asked("?last=30d&elements=kx_1_y1");
  ASSERT_TRUE(good.starts_with("HTTP/1.1 200")) << good.substr(0, 300);
  EXPECT_NE(good.find("Content-Security-Policy"), std::string::npos);
  const json j = json::parse(body_of(good));
  EXPECT_EQ(j["points"], 720);
  EXPECT_EQ(j["elements"][0]["median"][719], 1000 + kHours - 1);
  for (const auto& [query, code, why] :
       std::vector<std::tuple<std::string, std::string, std::string>>{
           {"?from=never", "400", "from: \"never\" is not a time"},
           {"?from=2024-10-05&to=2024-10-04", "400", "from must be before to"},
           {"?elements=kx_1_y2", "404", "the history has no kx_1_y2, did you mean kx_1_y1?"},
           {"?from=0001-01-01&to=9999-01-01", "400", "the span is too long"}}) {
    const std::string answer = asked(query);
    EXPECT_TRUE(answer.starts_with("HTTP/1.1 " + code)) << query << "\n" << answer.substr(0, 300);
    EXPECT_NE(answer.find(why), std::string::npos) << body_of(answer);
  }
  EXPECT_NE(view_.building_json().find("\"history\":true"), std::string::npos);
}

TEST_F(ServedYears, ManyRequestsAtOnceAreAllAnsweredAndThePageIsStillServed) {
  std::vector<std::string> answers(kAtOnce);
  {
    std::vector<std::jthread> viewers;
    for (std::string& answer : answers)
      viewers.emplace_back(
          [&] { answer = ask(server_.port(), request("GET /years.json?elements=kx_1_y1")); });
    EXPECT_TRUE(ask(server_.port(), request("GET /healthz")).starts_with("HTTP/1.1 200"));
  }
  int good = 0;
  for (const std::string& answer : answers) {
    const bool is_good = answer.starts_with("HTTP/1.1 200");
    good += is_good ? 1 : 0;
    if (is_good)
      EXPECT_EQ(json::parse(body_of(answer))["elements"].size(), 1u);
    else
      EXPECT_TRUE(answer.starts_with("HTTP/1.1 503") &&
                  answer.find("too many requests about the history are waiting") !=
                      std::string::npos)
          << answer.substr(0, 300);
  }
  EXPECT_GE(good, 16);
}

TEST_F(Served, YearsNeedAHistory) {
  const std::string answer = ask(server_.port(), request("GET /years.json"));
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 404"));
  EXPECT_NE(answer.find("the configuration has no [history]"), std::string::npos) << answer;
}

}  // namespace web_years_test
}  // namespace framewatch::daemon
