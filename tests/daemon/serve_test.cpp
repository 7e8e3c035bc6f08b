#include <cmath>
#include <filesystem>
#include <map>
#include <string>

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "daemon/change_watch.h"
#include "daemon/event_ring.h"
#include "daemon/live_view.h"
#include "daemon/serve_command.h"
#include "daemon/web_server.h"
#include "daemon/web_sessions.h"
#include "drivers/encoded.h"
#include "drivers/message_check.h"
#include "tests/daemon/config_fixture.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace {

// Limits.
constexpr std::size_t kPageBytes = 150'000;
constexpr double kSecondsToTell = 3;  // from the drop to the event, windows of 2.5 s each 0.5 s

std::string all(const EventRing& ring, EventRing::Cursor& cursor, std::size_t step) {
  std::string out, part(step, '\0');
  while (const std::size_t got = ring.read(cursor, part.data(), step)) out += part.substr(0, got);
  return out;
}

TEST(EventRing, EveryViewerReadsEverythingInItsOwnPieces) {
  EventRing ring(4);
  EventRing::Cursor a = ring.join("first\n\n"), b = ring.join("");
  std::string whole_a, whole_b, expected;
  for (int i = 0; i < 20; ++i) {
    ring.push("n", std::to_string(i));
    expected += "event: n\ndata: " + std::to_string(i) + "\n\n";
    whole_a += all(ring, a, 3);
    whole_b += all(ring, b, 1000);
  }
  EXPECT_EQ(whole_a, "first\n\n" + expected);
  EXPECT_EQ(whole_b, expected);
  EXPECT_EQ(a.dropped, 0u);
}

TEST(EventRing, ASlowViewerIsToldWhatItLost) {
  EventRing ring(4);
  EventRing::Cursor slow = ring.join("");
  ring.push("n", "0");
  char begun[5];
  ASSERT_EQ(ring.read(slow, begun, sizeof begun), sizeof begun);
  for (int i = 1; i < 100; ++i) ring.push("n", std::to_string(i));
  const std::string rest = all(ring, slow, 64);
  // What was begun is finished; then comes how many are gone, then the newest.
  EXPECT_EQ(rest,
            ": n\ndata: 0\n\nevent: dropped\ndata: {\"events\":98}\n\nevent: n\ndata: 99\n\n");
  EXPECT_EQ(slow.dropped, 98u);
}

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

TEST(ChangeWatch, NamesTheFrameThatDroppedAndWhenItIsBack) {
  ChangeWatch watch(table_of({"kx_1_y1", "kx_1_y2", "cx_1_y1"}, {0, 0, 2}), 2.5, 7);
  std::vector<event_t> events;
  double told_s = NAN;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.5 * i;
    // The window is mixed for 2.5 s; damping doubles, which is nobody's alarm.
    const double drop = t < 20 ? 0 : t < 60 ? 0.15 * std::min(1.0, (t - 20) / 2.5) : 0;
    const auto found =
        watch.observe(estimate_at(t, {30e3, 20e3 * (1 - drop), t < 20 ? 10.0 : 20.0}, 0.005));
    if (!found.empty() && events.empty()) told_s = t;
    events.insert(events.end(), found.begin(), found.end());
  }
  ASSERT_GE(events.size(), 2u);
  EXPECT_LE(told_s, 20 + kSecondsToTell);
  for (const event_t& e : events) {
    EXPECT_EQ(e.place, "kx_1_y2");
    EXPECT_EQ(e.id, 7);
  }
  EXPECT_EQ(events.front().state, 1);
  EXPECT_EQ(events.back().state, 0);
  EXPECT_NEAR(events[events.size() - 2].value, -0.15, 0.03);
}

TEST(ChangeWatch, NoiseAndSilenceRaiseNothing) {
  ChangeWatch watch(table_of({"kx_1_y1"}, {0}), 2.5, 1);
  for (int i = 0; i < 400; ++i) {
    window_estimate_t e =
        estimate_at(0.5 * i, {30e3 * (1 + 0.04 * std::sin(1.7 * i) * (i % 3 - 1))}, 0.03);
    if (i % 50 > 30) {
      e.reason[0] = 2;
      e.value[0] = e.std_error[0] = NAN;
    }
    EXPECT_TRUE(watch.observe(e).empty()) << i;
  }
  EXPECT_TRUE(std::isfinite(watch.baseline()[0]));
  watch.renew();
  EXPECT_TRUE(std::isnan(watch.baseline()[0]));
}

WebRequest get(const std::string& path, const std::string& host) {
  return {"GET", path, host, "", "", "", ""};
}

TEST(WebAdmission, HostMethodTokenOrigin) {
  WebSettings s;
  s.token = "0123456789abcdef";
  EXPECT_TRUE(problems(s).empty());
  for (const char* host : {"127.0.0.1:8080", "localhost", "[::1]:9"})
    EXPECT_EQ(admit(s, get("/", host)), Admission::served) << host;
  for (const char* host : {"evil.example", "", "127.0.0.1.evil.example", "[::1", "localhost.x:80"})
    EXPECT_EQ(admit(s, get("/", host)), Admission::wrong_host) << host;
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "POST", "PATCH"}) {
    WebRequest r = get("/", "localhost");
    r.method = method;
    EXPECT_EQ(admit(s, r), Admission::wrong_method) << method;
  }
  for (const char* path : {"/acknowledge", "/baseline", "/session"}) {
    WebRequest verb = get(path, "localhost:8080");
    verb.method = "POST";
    EXPECT_EQ(admit(s, verb), Admission::no_token);
    verb.cookie = "0123456789abcdeF";
    EXPECT_EQ(admit(s, verb), Admission::no_token);
    verb.cookie = s.token;
    EXPECT_EQ(admit(s, verb), Admission::served);
    verb.origin = "http://localhost:8080";
    EXPECT_EQ(admit(s, verb), Admission::served);
    verb.origin = "http://evil.example";
    EXPECT_EQ(admit(s, verb), Admission::wrong_origin);
  }
}

TEST(WebSessions, GiveOutReportsAndNothingElse) {
  const test::TemporaryDirectory directory;
  for (const char* name : {"2026-11-21T14-03-10_a", "2026-11-21T15-00-00"}) {
    std::filesystem::create_directory(directory.path(name));
    SessionFile session;
    session.request.test = name;
    test::write_file(directory.path(name) + "/session.json", session_json(session));
    test::write_file(directory.path(name) + "/raw.lcmlog", "raw");
  }
  test::write_file(directory.path("2026-11-21T15-00-00/report.html"), "<p>");
  test::write_file(directory.path("report.html"), "outside");
  const std::string folder = directory.path("");
  const auto list = nlohmann::json::parse(sessions_json(folder));
  ASSERT_EQ(list.size(), 2u);
  EXPECT_EQ(list[0]["session"], "2026-11-21T15-00-00");
  EXPECT_EQ(list[0]["report"], true);
  EXPECT_EQ(list[1]["report"], false);
  EXPECT_EQ(sessions_json("/nonexistent"), "[]");
  EXPECT_EQ(session_document(folder, "2026-11-21T15-00-00/report.html").value().content, "<p>");
  EXPECT_TRUE(session_document(folder, "2026-11-21T14-03-10_a/session.json"));
  for (const char* path :
       {"2026-11-21T15-00-00/raw.lcmlog", "../report.html", "./report.html", "report.html",
        "2026-11-21T15-00-00/../report.html", "2026-11-21T15-00-00/", "", "/report.html",
        "2026-11-21T15-00-00/report.html/x", "2026-11-21T14-03-10_a/report.html"})
    EXPECT_FALSE(session_document(folder, path)) << path;
  EXPECT_FALSE(session_document("", "2026-11-21T15-00-00/report.html"));
}

TEST(WebAdmission, OtherAddressesNeedATokenForEverything) {
  WebSettings s;
  s.address = "192.168.1.7";
  EXPECT_EQ(problems(s).size(), 1u);
  s.token = "short";
  EXPECT_EQ(problems(s).size(), 1u);
  s.token = "0123456789abcdef";
  EXPECT_TRUE(problems(s).empty());
  WebRequest r = get("/page.js", "192.168.1.7:8080");
  EXPECT_EQ(admit(s, r), Admission::no_token);
  r.authorization = "Bearer " + s.token;
  EXPECT_EQ(admit(s, r), Admission::served);
  r.host = "tower.example:8080";
  EXPECT_EQ(admit(s, r), Admission::wrong_host);
  s.hosts = {"tower.example"};
  EXPECT_EQ(admit(s, r), Admission::served);
}

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

/// Answer of a server on this machine: whole, or until `last` has come, if it is given.
std::string ask(int port, const std::string& request, const std::string& last = {}) {
  const int s = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  ::inet_pton(AF_INET, "127.0.0.1", &to.sin_addr);
  std::string out;
  timeval wait{5, 0};
  ::setsockopt(s, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
  if (::connect(s, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0 &&
      ::send(s, request.data(), request.size(), MSG_NOSIGNAL) > 0) {
    char part[4096];
    const auto all = [&] { return !last.empty() && out.find(last) != std::string::npos; };
    for (ssize_t got; !all() && (got = ::recv(s, part, sizeof part, 0)) > 0;)
      out.append(part, static_cast<std::size_t>(got));
  }
  ::close(s);
  return out;
}

std::string request(const std::string& line, const std::string& more = "") {
  return line + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + more + "\r\n";
}

class Served : public ::testing::Test {
 protected:
  Served()
      : config_(test::good(test::kGoodConfig)),
        view_(config_,
              [this](std::int64_t, const std::string& channel,
                     const std::vector<std::uint8_t>& bytes) { published_[channel] = bytes; }),
        server_(settings(), view_) {
    std::string error;
    const int socket = listen_on("127.0.0.1", 0, error);
    EXPECT_GE(socket, 0) << error;
    EXPECT_TRUE(server_.start(socket, error)) << error;
  }
  static WebSettings settings() {
    WebSettings s;
    s.token = "0123456789abcdef";
    return s;
  }
  template <typename Message>
  void send(const std::string& channel, const Message& message) {
    const std::vector<std::uint8_t> bytes = drivers::encoded(message);
    view_.message(channel, bytes.data(), bytes.size());
  }

  Config config_;
  std::map<std::string, std::vector<std::uint8_t>> published_;
  LiveView view_;
  WebServer server_;
};

TEST_F(Served, SessionVerbsGoToTheRecorderAndItsAnswersToThePage) {
  const std::string query =
      "POST /session?verb=arm&test=El%20Centro&operator=me&notes=&length_s=&trigger_mps2=0.2&"
      "pre_trigger_s=5";
  EXPECT_NE(ask(server_.port(), request(query)).find("403"), std::string::npos);
  const std::string cookie = "Cookie: framewatch=0123456789abcdef\r\n";
  for (const char* bad : {"&trigger_mps2=x", "&length_s=-1", "&length_s=1e99"})
    EXPECT_NE(ask(server_.port(), request(std::string("POST /session?verb=start") + bad, cookie))
                  .find("400"),
              std::string::npos);
  view_.flush();
  EXPECT_TRUE(published_.empty());
  const std::string answer = ask(server_.port(), request(query, cookie));
  EXPECT_NE(answer.find("202"), std::string::npos) << answer;
  view_.flush();
  const auto command = drivers::decode_session_command(published_["FRAMEWATCH_SESSION_COMMAND"]);
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
  // Both are there for a viewer that comes later.
  const std::string events = ask(server_.port(), request("GET /events"), "\"floor\":[0.125]");
  EXPECT_NE(events.find("\"answered\":\"" + std::to_string(command->id) + "\""), std::string::npos);
  EXPECT_NE(events.find("\"refused\":\"not \\\"now\\\"\""), std::string::npos) << events;
  EXPECT_NE(events.find("\"noise\":null"), std::string::npos);
  EXPECT_NE(events.find("\"overall\":0.25,\"noise_floor\":null"), std::string::npos);
}

TEST_F(Served, PageBuildingAndRefusals) {
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

TEST_F(Served, ValuesOnTheStreamAreThoseOfTheMessages) {
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

  EXPECT_FALSE(view_.acknowledge(41));
  EXPECT_TRUE(view_.acknowledge(42));
  const std::string stream = ask(server_.port(), request("GET /events"), "\"acknowledged\":true");
  EXPECT_NE(stream.find("text/event-stream"), std::string::npos);
  EXPECT_NE(stream.find("\"acknowledged\":true"), std::string::npos) << stream;
}

TEST_F(Served, WhatRunKeepsIsAcknowledgedThere) {
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
  EXPECT_TRUE(view_.acknowledge(7));
  EventRing::Cursor cursor = view_.join();
  view_.flush();
  const auto request = drivers::decode_acknowledge(published_["FRAMEWATCH_ACKNOWLEDGE"]);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->id, 7);
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

TEST_F(Served, BytesThatAreNoMessageChangeNothing) {
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

TEST(ServeCommand, RefusesToServeOthersWithoutAToken) {
  ServeArguments a;
  a.config = FRAMEWATCH_SOURCE_DIR "/configs/table_two_story.toml";
  a.address = "0.0.0.0";
  EXPECT_EQ(serve(a), 2);
  a.token_file = "/nowhere";
  EXPECT_EQ(serve(a), 2);
}

TEST(MessageCheck, StatusAndEventSurviveATripAndRefuseACut) {
  status_t s{};
  s.channels = 1;
  s.name = {"a"};
  s.received = s.lost = s.late = s.repaired = s.rejected = s.stuck = s.clipped = {3};
  s.noise_mps2_per_rthz = {0.5};
  std::vector<std::uint8_t> bytes = drivers::encoded(s);
  ASSERT_TRUE(drivers::decode_status(bytes));
  EXPECT_EQ(drivers::decode_status(bytes)->noise_mps2_per_rthz[0], 0.5);
  event_t e{};
  e.place = "kx_1_y1";
  std::vector<std::uint8_t> more = drivers::encoded(e);
  ASSERT_TRUE(drivers::decode_event(more));
  EXPECT_EQ(drivers::decode_event(more)->place, "kx_1_y1");
  for (auto* all_bytes : {&bytes, &more}) all_bytes->pop_back();
  EXPECT_FALSE(drivers::decode_status(bytes));
  EXPECT_FALSE(drivers::decode_event(more));
  EXPECT_FALSE(drivers::decode_event(bytes));
}

}  // namespace
}  // namespace framewatch::daemon
