// SPDX-License-Identifier: MIT
#include "daemon/page/view/live_view.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <framewatch/acknowledge_t.hpp>
#include <framewatch/acknowledged_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/parameter_table_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/session_command_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "drivers/lcm/message_check.h"
#include "tests/daemon/page/web/served.h"

namespace framewatch::daemon {
namespace live_view_test {

using test::ask, test::request, test::Served;

parameter_table_t table_of(const std::vector<std::string>& names, const std::vector<int>& kinds) {
  parameter_table_t table{};
  table.name = names;
  table.kind.assign(kinds.begin(), kinds.end());
  table.parameters = static_cast<std::int32_t>(names.size());
  return table;
}

window_estimate_t estimate_at(double end_s, std::vector<double> value, double relative_error) {
  window_estimate_t e{};
  e.window_end_us = static_cast<std::int64_t>(1e6 * end_s);
  e.parameters = static_cast<std::int32_t>(value.size());
  e.status = 1;
  e.reason.assign(value.size(), 0);
  for (const double v : value) e.std_error.push_back(relative_error * v);
  e.value = std::move(value);
  return e;
}

TEST_F(Served, StreamsTheValuesOfTheMessages) {
  parameter_table_t table = table_of({"kx_1_y1"}, {0});
  table.rate_hz = 100;
  table.unit = {"N/m"};
  table.story = {1};
  table.design = {1};
  send("FRAMEWATCH_PARAMETERS", table);
  window_estimate_t e = estimate_at(5, {12345.678901234567}, 0.01);
  e.snr = e.prior_share = e.noise_share = {1.0f};
  send("FRAMEWATCH_ESTIMATE", e);
  event_t alarm{};
  alarm.id = 42;
  alarm.state = 1;
  alarm.value = NAN;
  alarm.message = "</script>\n";
  send("FRAMEWATCH_EVENT", alarm);
  EventRing::Cursor cursor = view_.join();
  view_.flush();
  std::string text(100'000, '\0');
  text.resize(view_.read(cursor, text.data(), text.size()));
  const std::size_t at = text.find("event: estimate\ndata: ");
  ASSERT_NE(at, std::string::npos) << text;
  const auto json = nlohmann::json::parse(text.substr(at + 22, text.find('\n', at + 22) - at - 22));
  EXPECT_EQ(json["value"][0].get<double>(), 12345.678901234567);
  EXPECT_NE(text.find("\"id\":42"), std::string::npos);

  EXPECT_FALSE(view_.acknowledge(41, "the page"));
  EXPECT_EQ(view_.acknowledge(42, "the page"), 0);
  const std::string stream = ask(server_.port(), request("GET /events"), "\"acknowledged\":true");
  EXPECT_NE(stream.find("text/event-stream"), std::string::npos);
  EXPECT_NE(stream.find("\"acknowledged\":true"), std::string::npos) << stream;
}

TEST_F(Served, PassesAcknowledgementsToRun) {
  service_t service{};
  service.raised = 1;
  service.event_id = {7};
  service.event_since_us = {5};
  service.event_severity = {2};
  service.event_kind = {"gap"};
  service.event_place = {"F1-Y1"};
  service.event_message = {"they differ"};
  send("FRAMEWATCH_SERVICE", service);
  acknowledged_t known{};
  send("FRAMEWATCH_ACKNOWLEDGED", known);
  EventRing::Cursor cursor = view_.join();
  const auto asked = view_.acknowledge(7, "the page at ::1");
  ASSERT_TRUE(asked);
  const auto request = drivers::decoded<acknowledge_t>(given("run ACKNOWLEDGE"));
  ASSERT_TRUE(request);
  EXPECT_EQ(request->request, *asked);
  EXPECT_EQ(request->id, 7);
  EXPECT_EQ(request->who, "the page at ::1");
  EXPECT_TRUE(published_.empty());  // nothing over LCM
  std::string text(100'000, '\0');
  text.resize(view_.read(cursor, text.data(), text.size()));
  EXPECT_NE(text.find("they differ"), std::string::npos);
  EXPECT_EQ(text.find("\"acknowledged\":true"), std::string::npos);
  known.events = 1;
  known.id = known.since_us = {7};
  known.kind = known.place = {""};
  known.who = {"me"};
  known.comment = {"loose"};
  send("FRAMEWATCH_ACKNOWLEDGED", known);
  text.assign(100'000, '\0');
  text.resize(view_.read(cursor, text.data(), text.size()));
  EXPECT_NE(text.find("\"acknowledged\":true,\"who\":\"me\",\"comment\":\"loose\""),
            std::string::npos)
      << text;
  known = {};
  send("FRAMEWATCH_ACKNOWLEDGED", known);
  text.assign(100'000, '\0');
  text.resize(view_.read(cursor, text.data(), text.size()));
  EXPECT_NE(text.find("\"acknowledged\":false"), std::string::npos);
}

TEST_F(Served, TellsViewersThatNoDaemonAnswers) {
  problem_ = "no permission\nfor </script>";
  EventRing::Cursor cursor = view_.join();
  session_command_t command{};
  command.id = 1234;
  ASSERT_TRUE(view_.tell_recorder(command));
  std::string text;
  EXPECT_TRUE(test::comes_true(
      [&] {
        std::string more(100'000, '\0');
        more.resize(view_.read(cursor, more.data(), more.size()));
        text += more;
        return text.find("event: refused") != std::string::npos;
      },
      std::chrono::seconds(30)));
  EXPECT_NE(text.find("event: refused\ndata: {\"answered\":\"1234\",\"refused\":\"no "
                      "permission\\nfor </script>\"}\n"),
            std::string::npos)
      << text;
}

TEST(PageCommands, RefuseMoreCommandsThanTheQueueHolds) {
  std::promise<void> go;
  const std::future<void> gone = go.get_future();
  std::atomic<int> given = 0;
  PageCommands commands(
      [&](const std::string&, const CommandPacket&) {
        gone.wait();
        ++given;
        return CommandAnswer{true, "", {}};
      },
      [](const PageCommand&, const std::string&) {});
  int taken = 0;
  for (int i = 0; i < 100; ++i) taken += commands.add({"run", {"X", {}}, i}) ? 1 : 0;
  EXPECT_GE(taken, static_cast<int>(PageCommands::kMax));
  EXPECT_LE(taken, static_cast<int>(PageCommands::kMax) + 1);
  go.set_value();
  EXPECT_TRUE(test::comes_true([&] { return given == taken; }, std::chrono::seconds(30)));
}

TEST_F(Served, IgnoresBytesThatAreNotAMessage) {
  const std::uint8_t junk[40] = {1, 2, 3};
  for (const char* channel : {"FRAMEWATCH_PARAMETERS", "FRAMEWATCH_ESTIMATE", "FRAMEWATCH_STATUS",
                              "FRAMEWATCH_EVENT", "ACCEL", "ACCEL_CHANNELS"})
    view_.message(channel, junk, sizeof junk);
  EventRing::Cursor cursor = view_.join();
  view_.flush();
  char text[1000];
  const std::size_t got = view_.read(cursor, text, sizeof text);
  EXPECT_EQ(std::string(text, got), "retry: 1000\n\n");
}

}  // namespace live_view_test
}  // namespace framewatch::daemon
