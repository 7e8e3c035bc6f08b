// SPDX-License-Identifier: MIT
#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/session_command_t.hpp>
#include <framewatch/session_status_t.hpp>

#include "daemon/page/web/web_server.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "daemon/page/web/web_files.h"
#include "drivers/lcm/message_check.h"
#include "tests/daemon/page/web/served.h"

namespace framewatch::daemon {
namespace web_server_test {

using test::ask, test::request, test::Served;

// Limits.
constexpr std::size_t kPageBytes = 185'000;

TEST(Page, IsLightAndFetchesNothingFromElsewhere) {
  std::size_t bytes = 0;
  for (const auto& [path, file] : page_files()) {
    bytes += file.content.size();
    EXPECT_FALSE(file.content.empty()) << path;
    if (path.ends_with(".html")) {
      EXPECT_EQ(file.content.find("http"), std::string::npos);
    }
  }
  EXPECT_GT(page_files().size(), 5u);
  EXPECT_LT(bytes, kPageBytes);
}

TEST_F(Served, PassesSessionCommandsToTheRecorderAndAnswersBack) {
  const std::string query =
      "POST /session?verb=arm&test=El%20Centro&operator=me&notes=&length_s=&trigger_mps2=0.2&"
      "pre_trigger_s=5";
  EXPECT_NE(ask(server_.port(), request(query)).find("403"), std::string::npos);
  const std::string cookie = "Cookie: framewatch=0123456789abcdef\r\n";
  for (const char* bad : {"&trigger_mps2=x", "&length_s=-1", "&length_s=1e99"})
    EXPECT_NE(ask(server_.port(), request(std::string("POST /session?verb=start") + bad, cookie))
                  .find("400"),
              std::string::npos);
  EXPECT_TRUE(given_.empty());
  const std::string answer = ask(server_.port(), request(query, cookie));
  EXPECT_NE(answer.find("202"), std::string::npos) << answer;
  const auto command = drivers::decoded<session_command_t>(given("record SESSION_COMMAND"));
  EXPECT_TRUE(published_.empty());  // nothing over LCM
  ASSERT_TRUE(command);
  EXPECT_EQ(command->verb, "arm");
  EXPECT_EQ(command->test, "El Centro");
  EXPECT_EQ(command->trigger_mps2, 0.2);
  EXPECT_EQ(command->pre_trigger_s, 5);
  EXPECT_NE(answer.find(std::to_string(command->id)), std::string::npos);

  session_status_t s{};
  s.answered = command->id;
  s.refused = "not \"now\"";
  s.channels = 1;
  s.name = {"base-x"};
  for (auto* values :
       {&s.noise_mps2_per_rthz, &s.rms_mps2, &s.offset_mps2, &s.peak_mps2, &s.range_mps2})
    *values = {NAN};
  s.saturated = {2};
  s.polarity = {-1};
  s.problem = {"reversed"};
  send("FRAMEWATCH_SESSION", s);
  gap_t gap{};
  gap.overall_nrmse = 0.25;
  gap.noise_floor = NAN;
  gap.channels = 1;
  gap.name = {"base-x"};
  gap.nrmse = {0.5};
  gap.floor = {0.125};
  send("FRAMEWATCH_GAP", gap);
  // A later viewer gets both.
  const std::string events = ask(server_.port(), request("GET /events"), "\"floor\":[0.125]");
  EXPECT_NE(events.find("\"answered\":\"" + std::to_string(command->id) + "\""), std::string::npos);
  EXPECT_NE(events.find("\"refused\":\"not \\\"now\\\"\""), std::string::npos) << events;
  EXPECT_NE(events.find("\"noise\":null"), std::string::npos);
  EXPECT_NE(events.find("\"overall\":0.25,\"noise_floor\":null"), std::string::npos);
}

TEST_F(Served, SendsReadingsOfWeatherToRun) {
  config_.weather.push_back({.name = "outside_degc", .lcm_channel = "ROOF"});
  const std::string cookie = "Cookie: framewatch=0123456789abcdef\r\n";
  const auto post = [&](const std::string& query) {
    return ask(server_.port(), request("POST /weather?" + query, cookie));
  };
  const auto sent = [&] {
    published_.clear();
    view_.flush();
    return drivers::decoded<weather_t>(published_["ROOF"]);
  };
  EXPECT_NE(ask(server_.port(), request("POST /weather?name=outside_degc&value=4")).find("403"),
            std::string::npos);
  EXPECT_NE(post("name=inside_degc&value=4").find("404"), std::string::npos);
  for (const char* bad : {"", "&value=warm", "&value=nan", "&value=4&time=noon"})
    EXPECT_NE(post(std::string("name=outside_degc") + bad).find("400"), std::string::npos) << bad;
  EXPECT_NE(post("name=outside_degc&value=4").find("409"), std::string::npos);
  EXPECT_FALSE(sent());

  EXPECT_NE(post("name=outside_degc&value=-4.5&time=2026-11-28T12:00:00Z").find("202"),
            std::string::npos);
  auto reading = sent();
  ASSERT_TRUE(reading);
  EXPECT_EQ(reading->name, "outside_degc");
  EXPECT_EQ(reading->value, -4.5);
  EXPECT_EQ(reading->time_us, 1'795'867'200'000'000);

  window_estimate_t estimate{};
  estimate.window_end_us = 7'000'000;
  send("FRAMEWATCH_ESTIMATE", estimate);
  EXPECT_NE(post("name=outside_degc&value=5").find("202"), std::string::npos);
  reading = sent();
  ASSERT_TRUE(reading);
  EXPECT_EQ(reading->time_us, 7'000'000);
  std::string answer;
  for (int i = 0; i < 200 && answer.find("503") == std::string::npos; ++i)
    answer = post("name=outside_degc&value=5");
  EXPECT_NE(answer.find("503"), std::string::npos) << answer;
}

TEST_F(Served, AnAcknowledgementContainsTheViewersAddress) {
  event_t alarm{};
  alarm.id = 42;
  alarm.state = 1;
  alarm.kind = "gap";
  send("FRAMEWATCH_EVENT", alarm);
  send("FRAMEWATCH_ACKNOWLEDGED", acknowledged_t{});  // framewatch run keeps the acknowledgements
  const std::string answer =
      ask(server_.port(),
          request("POST /acknowledge?id=42", "Cookie: framewatch=0123456789abcdef\r\n"));
  const auto given_to_run = drivers::decoded<acknowledge_t>(given("run ACKNOWLEDGE"));
  ASSERT_TRUE(given_to_run);
  EXPECT_EQ(given_to_run->who, "the page at 127.0.0.1");
  EXPECT_NE(answer.find("202"), std::string::npos) << answer;
  EXPECT_NE(answer.find(std::to_string(given_to_run->request)), std::string::npos) << answer;
}

TEST(Page, InsertsTextsNeverAsMarkup) {
  for (const auto& [path, file] : page_files())
    for (const char* way : {"innerHTML", "outerHTML", "insertAdjacentHTML", "document.write",
                            "eval(", "new Function", "srcdoc"})
      EXPECT_EQ(file.content.find(way), std::string::npos) << path << ": " << way;
}

TEST_F(Served, ServesPageAndBuildingAndRefusesOthers) {
  const std::string page = ask(server_.port(), request("GET /"));
  EXPECT_NE(page.find("200 OK"), std::string::npos);
  EXPECT_NE(page.find("Content-Security-Policy: default-src 'none'"), std::string::npos);
  EXPECT_NE(page.find("</html>"), std::string::npos);
  const std::string building = ask(server_.port(), request("GET /building.json"));
  const auto json = nlohmann::json::parse(building.substr(building.find("\r\n\r\n") + 4));
  EXPECT_EQ(json["parameters"].size(), 10u);
  EXPECT_EQ(json["axes"][2]["name"], "F1-Y1");
  EXPECT_NE(ask(server_.port(), request("GET /../etc/passwd")).find("404"), std::string::npos);
  EXPECT_NE(ask(server_.port(), request("POST /acknowledge?id=1")).find("403"), std::string::npos);
  EXPECT_NE(ask(server_.port(),
                request("POST /acknowledge?id=1", "Cookie: framewatch=0123456789abcdef\r\n"))
                .find("404"),
            std::string::npos);
  EXPECT_NE(ask(server_.port(), "GET / HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n")
                .find("421"),
            std::string::npos);
  const std::string exchanged = ask(server_.port(), request("GET /?token=0123456789abcdef"));
  EXPECT_NE(exchanged.find("303"), std::string::npos);
  EXPECT_NE(exchanged.find("HttpOnly; SameSite=Strict"), std::string::npos);
}

}  // namespace web_server_test
}  // namespace framewatch::daemon
