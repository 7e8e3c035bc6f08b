// SPDX-License-Identifier: MIT
#include "fleet/uplink/uplink.h"

#include <framewatch/summary_t.hpp>

#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"
#include "tests/fleet/uplink/uplink_fixture.h"

namespace framewatch::fleet {
namespace uplink_test {

constexpr int kEvents = 30;
constexpr std::size_t kPeriodsOfAnHour = 7;  // ten minutes and the hour; minutes are not sent

class UplinkRules : public test::UplinkTest {};

event_t live_event(int id, std::int64_t time_us) {
  event_t e{};
  e.kind = "gap";
  e.id = id;
  e.time_us = e.since_us = time_us;
  e.state = 1;
  return e;
}

TEST_F(UplinkRules, SendsEveryMessageOfTheHistoryOnce) {
  for (int i = 0; i < kEvents; ++i) add_event(i, test::kStart_us + i);
  add_hour(test::kStart_us);
  begin();
  run(60);
  EXPECT_EQ(hub_.count("a/event/gap/"), std::size_t{kEvents});
  EXPECT_EQ(hub_.count("a/summary/"), kPeriodsOfAnHour);
  EXPECT_EQ(kept_twice(), 0U);
  EXPECT_EQ(uplink_->status(now()).events_waiting, 0);
  EXPECT_EQ(uplink_->status(now()).summaries_waiting, 0);
}

TEST_F(UplinkRules, SendsASummaryAsTheHistoryHoldsIt) {
  add_hour(test::kStart_us);
  begin();
  run(5);
  for (const Message& m : hub_.published) {
    if (m.header(header::kKey) != fmt::format("a/summary/600/{}", test::kStart_us)) continue;
    EXPECT_EQ(m.subject, "fw.up.a.summary.600");
    EXPECT_EQ(m.header(header::kType), "summary_t");
    std::string why;
    const auto bytes = unpacked(m, 1 << 20, why);
    ASSERT_TRUE(bytes) << why;
    const auto s = drivers::decoded<summary_t>(*bytes);
    ASSERT_TRUE(s);
    EXPECT_EQ(s->config_sha256, "sha-a");
    ASSERT_EQ(s->parameters, 1);
    EXPECT_EQ(s->observable[0], 10);
    EXPECT_FLOAT_EQ(s->median[0], 2);
    EXPECT_FLOAT_EQ(s->q1[0], 1.5);
    ASSERT_EQ(s->channels, 1);
    EXPECT_EQ(s->received[0], 100);
    EXPECT_EQ(s->lost[0], 1);
    return;
  }
  ADD_FAILURE() << "no such summary";
}

TEST_F(UplinkRules, SendsAnEventAtOnceAndOnlyOnce) {
  begin();
  run(2);
  uplink_->heard("EVENT", drivers::encoded(live_event(1, test::kStart_us)));
  uplink_->step(now());
  ASSERT_EQ(hub_.count("a/event/gap/1/"), 1U);
  add_event(1, test::kStart_us);  // it is in the history a second later
  run(10);
  EXPECT_EQ(kept_twice(), 0U);
}

TEST_F(UplinkRules, SendsAPeriodOnlyWhenItIsOver) {
  add_hour(test::kStart_us, 1);
  sql("DELETE FROM period WHERE start_us >= " +
      std::to_string(test::kStart_us + 1800 * test::kSecond));
  sql("INSERT INTO period VALUES (3600, " + std::to_string(test::kStart_us) +
      ", 1, 1, 1)"
      " ON CONFLICT DO NOTHING");
  begin();
  run(10);
  EXPECT_EQ(hub_.count("a/summary/600/"), 2U);  // nothing has closed the third yet
  EXPECT_EQ(hub_.count("a/summary/3600/"), 0U);
}

TEST_F(UplinkRules, ResendsAPeriodThatGrew) {
  add_hour(test::kStart_us, 1);
  begin();
  run(10);
  const std::string key = fmt::format("a/summary/600/{}", test::kStart_us);
  EXPECT_EQ(hub_.stored[key], 1);
  sql("UPDATE period SET windows = windows + 5");
  run(10);
  EXPECT_EQ(hub_.stored[key], 1);
  sql("UPDATE period SET open = 0");
  run(10);
  EXPECT_EQ(hub_.stored[key], 2);
  run(60);
  EXPECT_EQ(hub_.stored[key], 2);
}

// A stream accepts one Nats-Msg-Id only once within minutes.
TEST_F(UplinkRules, TheHubAcceptsAPeriodThatGrew) {
  secret_ = "mine";
  add_hour(test::kStart_us, 1);
  begin();
  run(10);
  const std::string key = fmt::format("a/summary/600/{}~", test::kStart_us);
  EXPECT_EQ(hub_.count(key), 1U);
  sql("UPDATE period SET windows = windows + 5, open = 0");
  run(10);
  EXPECT_EQ(hub_.count(key), 2U);
  EXPECT_EQ(kept_twice(), 0U);
}

TEST_F(UplinkRules, AnAbsentHubCostsOnlyTime) {
  begin();
  run(2);
  hub_.up = false;
  for (int i = 0; i < kEvents; ++i) {
    add_event(i, test::kStart_us + i);
    uplink_->heard("EVENT", drivers::encoded(live_event(i, test::kStart_us + i)));
  }
  add_hour(test::kStart_us);
  const std::size_t before = hub_.published.size();
  run(3600, 1'000'000);
  EXPECT_EQ(hub_.published.size(), before);
  EXPECT_EQ(uplink_->status(now()).connected, 0);
  EXPECT_GE(uplink_->status(now()).events_waiting, kEvents);
  hub_.reconnect();
  run(20);
  EXPECT_EQ(hub_.count("a/event/gap/"), std::size_t{kEvents});
  EXPECT_EQ(hub_.count("a/summary/"), kPeriodsOfAnHour);
}

TEST_F(UplinkRules, TriesAHubThatRefusesOnceASecond) {
  for (int i = 0; i < 400; ++i) add_event(i, test::kStart_us + i);
  begin();
  hub_.answers = false;
  run(5);
  const std::size_t before = hub_.published.size();
  run(60);
  EXPECT_LE(hub_.published.size() - before, 62U);
  EXPECT_GE(hub_.published.size() - before, 55U);
  hub_.answers = true;
  run(10);
  EXPECT_EQ(hub_.count("a/event/gap/"), 400U);
}

TEST_F(UplinkRules, LosesNothingInAPowerCutOfTheHub) {
  for (int i = 0; i < kEvents; ++i) add_event(i, test::kStart_us + i);
  add_hour(test::kStart_us);
  begin();
  run(30);
  ASSERT_EQ(hub_.count("a/event/gap/"), std::size_t{kEvents});
  hub_.stored.clear();  // acknowledged, but not yet on its disk
  hub_.up = false;
  run(7200, 1'000'000);  // two hours without; the duration does not matter
  hub_.reconnect();
  run(30);
  EXPECT_EQ(hub_.count("a/event/gap/"), std::size_t{kEvents});
  EXPECT_EQ(hub_.count("a/summary/"), kPeriodsOfAnHour);
}

TEST_F(UplinkRules, LosesNothingInASecondOutageDuringResending) {
  for (int id = 0; id < 3; ++id) add_event(id, test::kStart_us + id);
  begin();
  run(2);
  EXPECT_EQ(hub_.count("a/event/"), 3U);
  hub_.stored.clear();  // its power is cut
  hub_.answers = false;
  for (int i = 0; i < 3; ++i) {
    hub_.reconnect();
    run(3);
  }
  begin();  // and the uplink is killed
  run(3);
  hub_.answers = true;
  run(10);
  EXPECT_EQ(hub_.count("a/event/"), 3U);
}

TEST_F(UplinkRules, AnUnstableLineDoesNotResendForever) {
  add_event(1, test::kStart_us);
  begin();
  run(2);
  EXPECT_EQ(hub_.stored["a/event/gap/1/" + std::to_string(test::kStart_us) + "/1"], 1);
  std::size_t sent = 0;
  for (int i = 0; i < 6; ++i) {
    for (int more = 0; more < 4; ++more) {  // acknowledgements come all the time
      add_event(100 + 4 * i + more, test::kStart_us + 100 + 4 * i + more);
      run(90, 500'000);
    }
    hub_.reconnect();
    run(3);
    const auto& all = hub_.published;
    sent = static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [](const Message& m) {
      return m.header(header::kKey).find("/gap/1/") != std::string::npos;
    }));
  }
  EXPECT_EQ(sent, 2u);  // 6 min after the first interruption, not after later ones
}

TEST_F(UplinkRules, DoesNotResendOldAcknowledgedMessages) {
  for (int i = 0; i < kEvents; ++i) add_event(i, test::kStart_us + i);
  begin();
  run(10);
  run(900, 1'000'000);
  add_event(1000, test::kStart_us + 1000);
  run(10);
  hub_.reconnect();
  run(30);
  EXPECT_EQ(kept_twice(), 1U);  // only the newest
}

TEST_F(UplinkRules, SendsTheRestAfterBeingKilled) {
  for (int i = 0; i < kEvents; ++i) add_event(i, test::kStart_us + i);
  begin();
  uplink_->step(now());  // sent, answer not read
  uplink_.reset();
  begin();
  run(20);
  EXPECT_EQ(hub_.count("a/event/gap/"), std::size_t{kEvents});
}

TEST_F(UplinkRules, LosesNothingWhenTheClockJumps) {
  begin();
  run(2);
  add_event(1, test::kStart_us);
  run(2);
  host_us_ += 365 * 24 * test::kHour_us;
  add_event(2, test::kStart_us + 365 * 24 * test::kHour_us);
  run(2);
  host_us_ -= 2 * 365 * 24 * test::kHour_us;
  add_event(3, test::kStart_us - 365 * 24 * test::kHour_us);
  run(2);
  EXPECT_EQ(hub_.count("a/event/gap/"), 3U);
  uplink_.reset();
  begin();  // the clock is behind every acknowledgement
  run(2);
  add_event(4, test::kStart_us);
  run(2);
  hub_.stored.clear();
  hub_.reconnect();
  run(5);
  EXPECT_EQ(hub_.count("a/event/gap/4/"), 1U);
}

TEST_F(UplinkRules, SendsFourOldSummariesASecondAfterEvents) {
  for (int h = 0; h < 24; ++h) add_hour(test::kStart_us + h * test::kHour_us);
  begin();
  run(5);
  const std::size_t early = hub_.count("a/summary/");
  EXPECT_LE(early, 4 * kPeriodsOfAnHour + 5 * 4 + 8);
  uplink_->heard("EVENT", drivers::encoded(live_event(1, test::kStart_us)));
  run(0.1);
  EXPECT_EQ(hub_.count("a/event/"), 1U);
  run(45);
  EXPECT_EQ(hub_.count("a/summary/"), 24 * kPeriodsOfAnHour);
}

TEST_F(UplinkRules, SendsMinutesAroundAnEvent) {
  add_hour(test::kStart_us);
  add_hour(test::kStart_us + test::kHour_us);
  add_event(1, test::kStart_us + 1800 * test::kSecond, 1);
  begin();
  run(60);
  EXPECT_EQ(hub_.count("a/summary/60/"), 70U);  // 10 before it, 60 after
}

TEST_F(UplinkRules, KeepsMessagesThatAFullHubRefuses) {
  add_event(1, test::kStart_us);
  begin();
  // JetStream's message.
  hub_.error = R"({"error":{"code":503,"err_code":10077,"description":"maximum bytes exceeded"}})";
  run(10);
  EXPECT_EQ(hub_.count("a/event/"), 0U);
  EXPECT_EQ(uplink_->status(now()).refusal, "maximum bytes exceeded");
  hub_.error.clear();
  run(70);
  EXPECT_EQ(hub_.count("a/event/"), 1U);
}

TEST_F(UplinkRules, ContinuesWithANewHistory) {
  add_event(1, test::kStart_us);
  begin();
  run(3);
  history_.close();
  for (const char* ending : {"", "-wal", "-shm"})
    std::filesystem::remove(daemon::summary_file(directory()) + ending);
  run(3);
  EXPECT_NE(uplink_->status(now()).store_trouble, "");
  ASSERT_TRUE(history_.open(daemon::summary_file(directory())));
  ASSERT_EQ(daemon::upgrade(history_, daemon::history_schema()), "");
  add_event(2, test::kStart_us + 1);
  run(5);
  EXPECT_EQ(hub_.count("a/event/"), 2U);
  EXPECT_EQ(uplink_->status(now()).store_trouble, "");
}

TEST_F(UplinkRules, SetsADamagedOutboxAsideAndResendsEverything) {
  add_event(1, test::kStart_us);
  framewatch::test::write_file(folder_.path("uplink.sqlite"), std::string(8192, 'x'));
  begin();
  run(5);
  EXPECT_EQ(hub_.count("a/event/"), 1U);
  EXPECT_EQ(uplink_->status(now()).store_trouble, "");
}

TEST_F(UplinkRules, ReportsAnUnwritableOutboxWithoutFlooding) {
  for (int i = 0; i < kEvents; ++i) add_event(i, test::kStart_us + i);
  std::filesystem::create_directory(folder_.path("uplink.sqlite"));
  begin();
  uplink_->heard("EVENT", drivers::encoded(live_event(900, test::kStart_us)));
  run(20);
  EXPECT_NE(uplink_->status(now()).store_trouble, "");
  EXPECT_EQ(hub_.count("a/event/gap/900/"), 1U);  // live events are sent anyway
  EXPECT_LE(hub_.published.size(), 3U);
  std::filesystem::remove(folder_.path("uplink.sqlite"));
  run(5);
  EXPECT_EQ(hub_.count("a/event/"), std::size_t{kEvents} + 1);
}

}  // namespace uplink_test
}  // namespace framewatch::fleet
