// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/base/sqlite_file.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/history_schema.h"
#include "fleet/link/link.h"
#include "fleet/message/address.h"
#include "fleet/uplink/uplink.h"
#include "tests/support/temporary.h"

namespace framewatch::fleet::test {

inline constexpr std::int64_t kSecond = 1'000'000;
inline constexpr std::int64_t kHour_us = 3600 * kSecond;
inline constexpr std::int64_t kStart_us = 472'223 * kHour_us;  ///< of the history, a whole hour

/// A hub that keeps published messages by key, like a stream, and acknowledges them.
class FakeHub : public Link {
 public:
  bool up = true;                     ///< connected
  bool answers = true;                ///< false: it accepts nothing (a dead line, no quorum)
  std::string error;                  ///< sent as every answer, instead of an acknowledgement
  std::map<std::string, int> stored;  ///< by key: number of publications
  std::vector<Message> published;     ///< all messages in order
  std::vector<Message> answered;      ///< messages to reply subjects of others
  std::vector<std::string> subjects;

  [[nodiscard]] bool publish(const Message& message) override {
    if (!up) return false;
    if (!message.subject.starts_with("fw.up.")) {
      answered.push_back(message);
      return true;
    }
    published.push_back(message);
    if (!answers) return true;
    const std::string key = message.header(header::kKey);
    const bool twice = error.empty() && stored[key]++ > 0;
    Message ack;
    ack.subject = message.reply;
    const std::string text = !error.empty() ? error
                             : twice        ? R"({"stream":"FW","seq":1,"duplicate":true})"
                                            : R"({"stream":"FW","seq":1})";
    ack.bytes.assign(text.begin(), text.end());
    waiting_.push_back(std::move(ack));
    return true;
  }
  void listen(const std::string& subject) override { subjects.push_back(subject); }
  std::vector<Message> take() override { return std::exchange(waiting_, {}); }
  std::int64_t connections() const override { return connections_; }
  bool is_connected() const override { return up; }
  std::string trouble() const override { return up ? "" : "no route to host"; }
  std::string inbox() const override { return "_INBOX_a.1"; }

  void reconnect() {
    up = true;
    ++connections_;
  }
  void bring(Message message) { waiting_.push_back(std::move(message)); }
  std::size_t count(const std::string& part) const {
    return static_cast<std::size_t>(
        std::count_if(stored.begin(), stored.end(),
                      [&](const auto& one) { return one.first.find(part) != std::string::npos; }));
  }

 private:
  std::vector<Message> waiting_;
  std::int64_t connections_ = 1;
};

/// A history as `framewatch run` leaves it, with an uplink. run() lets time pass.
class UplinkTest : public ::testing::Test {
 protected:
  UplinkTest() {
    EXPECT_TRUE(history_.open(daemon::summary_file(directory()))) << history_.error();
    EXPECT_EQ(daemon::upgrade(history_, daemon::history_schema()), "");
    sql("PRAGMA synchronous = OFF");
    sql("INSERT INTO config VALUES ('sha-a', 'building', '1', 0)");
    sql("INSERT INTO parameter (name, unit, kind, story) VALUES ('kx_1_y1', 'N/m', 0, 1)");
    sql("INSERT INTO channel (name) VALUES ('base-x')");
    settings_.building = "a";
    settings_.accept = {"acknowledge", "raw", "resend", "minutes"};
  }

  std::string directory() const { return folder_.path("."); }
  void sql(const std::string& text) { EXPECT_TRUE(history_.execute(text)) << history_.error(); }

  void add_event(int id, std::int64_t time_us, int severity = 0, int state = 1) {
    sql(fmt::format("INSERT INTO event VALUES ('gap', {}, {}, {}, {}, {}, '', 1, 0.1, '', 'm', '')",
                    id, time_us, state, time_us, severity));
  }
  /// Adds every period of an hour; closed if `open` is 0.
  void add_hour(std::int64_t start_us, int open = 0) {
    sql("BEGIN");
    for (const std::int64_t period_s : {60, 600, 3600})
      for (std::int64_t at_us = start_us; at_us < start_us + kHour_us;
           at_us += period_s * kSecond) {
        sql(fmt::format("INSERT INTO period VALUES ({}, {}, {}, {}, {})", period_s, at_us,
                        100 * period_s, at_us + period_s * kSecond - 10'000, open));
        sql(fmt::format(
            "INSERT INTO summary VALUES (1, {}, {}, 10, 2, 0.1, 1, 1, 1.5, 2, 2.5, 3, 3,"
            " 0, 5)",
            period_s, at_us));
        sql(fmt::format(
            "INSERT INTO channel_summary VALUES (1, {}, {}, 100, 1, 0, 0, 0, 0, 0, 1e-5)", period_s,
            at_us));
      }
    sql("COMMIT");
  }

  void begin(std::unique_ptr<RawExporter> exporter = nullptr) {
    daemon::HistorySettings history;
    history.directory = directory();
    uplink_ = std::make_unique<Uplink>(
        UplinkSettings{settings_, history, "", secret_}, hub_,
        [this](const acknowledge_t& request) {
          acknowledged_.push_back(request);
          return acknowledge_problem_;
        },
        std::move(exporter), now());
  }
  Instant now() const { return {steady_us_, host_us_}; }
  void run(double seconds, std::int64_t step_us = 50'000) {
    for (const std::int64_t end = steady_us_ + static_cast<std::int64_t>(seconds * 1e6);
         steady_us_ < end;) {
      steady_us_ += step_us;
      host_us_ += step_us;
      uplink_->step(now());
    }
  }
  std::size_t kept_twice() const {
    return static_cast<std::size_t>(std::count_if(hub_.stored.begin(), hub_.stored.end(),
                                                  [](const auto& one) { return one.second > 1; }));
  }

  framewatch::test::TemporaryDirectory folder_;
  daemon::SqliteFile history_;
  daemon::FleetSettings settings_;
  FakeHub hub_;
  std::vector<acknowledge_t> acknowledged_;
  std::string acknowledge_problem_, secret_;
  std::unique_ptr<Uplink> uplink_;
  std::int64_t steady_us_ = 5 * kSecond, host_us_ = kStart_us + 10 * kHour_us;
};

}  // namespace framewatch::fleet::test
