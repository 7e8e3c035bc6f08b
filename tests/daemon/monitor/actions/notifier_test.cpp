// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/notifier.h"

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <framewatch/event_t.hpp>

#include "daemon/monitor/actions/webhook.h"
#include "daemon/monitor/events/event_messages.h"
#include "tests/daemon/monitor/actions/example_event.h"
#include "tests/support/child.h"
#include "tests/support/history_fixture.h"
#include "tests/support/http_server.h"

namespace framewatch::daemon {
namespace notifier_test {

using namespace std::chrono_literals;

// Limits.
constexpr double kNoWaitForAThousand_s = 2;  // time that the caller may lose
constexpr double kLongestEnd_s = 30;  // with a receiver that does not answer: 2 s and the last poll
constexpr auto kSoon = 60s;           // for short actions on an idle machine

TEST(Notifier, NeverBlocksItsCallerAndEndsInTime) {
  std::atomic<int> begun = 0;
  double end_s = 0;
  {
    Notifier notifier("test",
                      [&](const ActionSettings&, const event_t&, const Abandoned& abandoned) {
                        ++begun;
                        while (!abandoned()) std::this_thread::sleep_for(10ms);
                        return DeliveryResult{"nobody listens", true};
                      });
    notifier.configure({}, 3600);
    EXPECT_LT(seconds_for([&] {
                for (int i = 0; i < 1000; ++i) notifier.event(event(i), false);
              }),
              kNoWaitForAThousand_s);
    EXPECT_TRUE(test::comes_true([&] { return begun > 0; }, kSoon));
    const Notifier::Counters c = notifier.counters();
    EXPECT_EQ(c.waiting + c.lost, 1000);
    EXPECT_GT(c.lost_us, 0);
    end_s = 1e-6 * static_cast<double>(steady_clock_us());
  }
  EXPECT_LT(1e-6 * static_cast<double>(steady_clock_us()) - end_s, kLongestEnd_s);
}

DeliveryResult post(const ActionSettings& s, const event_t& e, const Abandoned& abandoned) {
  return post_webhook(s, e, "b", abandoned);
}

TEST(Notifier, RetriesUntilTheServerAcceptsAndCountsFailures) {
  test::HttpServer server;
  server.answer({500, 503, 200, 404, 200});
  ActionSettings settings;
  settings.webhook = "http://127.0.0.1:" + std::to_string(server.port());
  Notifier notifier("webhook", post);
  notifier.configure(settings, 60);
  notifier.event(event(1), false);
  EXPECT_TRUE(test::comes_true([&] { return !notifier.counters().trouble.empty(); }, kSoon));
  EXPECT_EQ(notifier.counters().waiting, 1);
  EXPECT_TRUE(test::comes_true([&] { return notifier.counters().told == 1; }, kSoon));
  EXPECT_EQ(notifier.counters().trouble, "");
  notifier.event(event(2), false);
  EXPECT_TRUE(test::comes_true([&] { return notifier.counters().lost == 1; }, kSoon));
  EXPECT_TRUE(notifier.counters().trouble.starts_with("the server answers 404"));
  notifier.event(event(3), false);
  EXPECT_TRUE(test::comes_true([&] { return notifier.counters().told == 2; }, kSoon));
  EXPECT_EQ(server.requests().size(), 5u);
}

TEST(Notifier, SendsWaitingEventsToAReturningServerUntilATimeout) {
  int port = 0;
  {
    test::HttpServer server;
    port = server.port();
  }
  ActionSettings settings;
  settings.webhook = "http://127.0.0.1:" + std::to_string(port);
  Notifier notifier("webhook", post);
  notifier.configure(settings, 60);
  notifier.event(event(1), false);
  notifier.event(event(2), false);
  EXPECT_TRUE(test::comes_true([&] { return !notifier.counters().trouble.empty(); }, kSoon));
  {
    test::HttpServer server(port);
    EXPECT_TRUE(test::comes_true([&] { return notifier.counters().told == 2; }, kSoon));
  }
  notifier.configure(settings, 0.5);
  notifier.event(event(3), false);
  EXPECT_TRUE(test::comes_true([&] { return notifier.counters().lost == 1; }, kSoon));
}

TEST(Notifier, WaitsAsLongAsTheServerAsks) {
  test::HttpServer server;
  server.answer({429, 200});
  server.say("", "3");
  ActionSettings settings;
  settings.webhook = "http://127.0.0.1:" + std::to_string(server.port());
  Notifier notifier("webhook", post);
  notifier.configure(settings, 60);
  const double waited_s = seconds_for([&] {
    notifier.event(event(1), false);
    EXPECT_TRUE(test::comes_true([&] { return notifier.counters().told == 1; }, 40s));
  });
  EXPECT_GE(waited_s, 3);
  EXPECT_EQ(server.requests().size(), 2u);
}

TEST(Notifier, DoesNotRepeatAnAcknowledgedEvent) {
  Notifier notifier("test", [](const ActionSettings&, const event_t& e, const Abandoned&) {
    return e.state == event_state::cleared ? DeliveryResult{} : DeliveryResult{"closed", true};
  });
  notifier.configure({}, 3600);
  notifier.event(event(1), false);
  EXPECT_TRUE(test::comes_true([&] { return !notifier.counters().trouble.empty(); }, 30s));
  notifier.acknowledged(event(2));
  EXPECT_EQ(notifier.counters().waiting, 1);
  notifier.acknowledged(event(1));
  EXPECT_TRUE(test::comes_true([&] { return notifier.counters().waiting == 0; }, 30s));
  EXPECT_EQ(notifier.counters().lost, 0);
  notifier.event(event(1, event_state::cleared), false);
  EXPECT_TRUE(test::comes_true([&] { return notifier.counters().told == 1; }, 30s));
}

TEST(Notifier, CountsAPartlyDeliveredEventAsToldAndKeepsTheTrouble) {
  Notifier notifier("email", [](const ActionSettings&, const event_t&, const Abandoned&) {
    DeliveryResult out{"b@example.org: refused", false};
    out.partly = true;
    return out;
  });
  notifier.configure({}, 60);
  notifier.event(event(1), false);
  EXPECT_TRUE(test::comes_true([&] { return notifier.counters().told == 1; }, 30s));
  EXPECT_EQ(notifier.counters().trouble, "b@example.org: refused");
  EXPECT_EQ(notifier.counters().lost, 0);
}

}  // namespace notifier_test

namespace action_queue_test {

std::vector<std::int64_t> ids(ActionQueue& queue, std::int64_t now_us) {
  std::vector<std::int64_t> out;
  while (const auto e = queue.take(now_us)) out.push_back(e->id);
  return out;
}

TEST(ActionQueue, NotifiesOfSevereEventsAndTheirEnd) {
  ActionQueue queue;
  ActionSettings settings;
  settings.kinds = {"stiffness_change", "gap"};
  queue.configure(settings);
  queue.put(event(1, event_state::raised, severity::information), false, 0);
  queue.put(event(1, event_state::cleared, severity::warning), false, 0);
  event_t other = event(2);
  other.kind = "bus_off";
  queue.put(other, false, 0);
  EXPECT_EQ(queue.waiting(), 0u);
  queue.put(event(3), false, 0);
  EXPECT_EQ(ids(queue, 0), std::vector<std::int64_t>{3});
  queue.put(event(3, event_state::cleared, severity::information), false, 0);
  EXPECT_EQ(ids(queue, 0), std::vector<std::int64_t>{3});
  queue.put(event(3, event_state::cleared, severity::information), false, 0);
  EXPECT_EQ(queue.waiting(), 0u);
}

TEST(ActionQueue, NotifiesOfEventsThatBeginAndEndAtOnce) {
  ActionQueue queue;
  queue.configure({});
  event_t e = event(1, event_state::cleared);
  e.since_us = e.time_us;
  queue.put(e, false, 0);
  EXPECT_EQ(queue.waiting(), 1u);
}

TEST(ActionQueue, KeepsLessSevereEventsForTheEndOfQuietHours) {
  ActionQueue queue;
  queue.configure({});
  queue.put(event(1, event_state::raised, severity::warning), false, 0);
  queue.put(event(2), false, 0);
  queue.put(event(3, event_state::raised, severity::warning), false, 0);
  EXPECT_EQ(queue.take(1, severity::alarm)->id, 2);
  EXPECT_FALSE(queue.take(1, severity::alarm));
  queue.put(event(3, event_state::cleared, severity::warning), false, 2);
  EXPECT_EQ(ids(queue, 3), (std::vector<std::int64_t>{1, 3}));
}

TEST(ActionQueue, DeliversTheDailyMessageWhateverItsSeverity) {
  ActionQueue queue;
  ActionSettings settings;
  settings.severity = severity::alarm;
  settings.kinds = {"gap"};
  queue.configure(settings);
  event_t e = event(1, event_state::cleared, severity::information);
  e.since_us = e.time_us;
  queue.put(e, false, 0);
  EXPECT_EQ(queue.waiting(), 0u);
  e.kind = kWellKind;
  queue.put(e, false, 0);
  EXPECT_EQ(ids(queue, 0), std::vector<std::int64_t>{1});
}

TEST(ActionQueue, DelaysChangesAndNotifiesOfTheNewest) {
  ActionQueue queue;
  ActionSettings settings;
  settings.changed_every_s = 10;
  queue.configure(settings);
  queue.put(event(1), false, 0);
  EXPECT_EQ(ids(queue, 0).size(), 1u);
  for (int i = 1; i <= 5; ++i) {
    event_t e = event(1, event_state::changed);
    e.value = i;
    queue.put(e, false, i * kSecond_us);
  }
  EXPECT_EQ(queue.merged(), 4);
  EXPECT_FALSE(queue.take(10 * kSecond_us - 1));
  const auto told = queue.take(10 * kSecond_us);
  ASSERT_TRUE(told);
  EXPECT_EQ(told->value, 5);
  queue.put(event(1, event_state::changed), false, 11 * kSecond_us);
  queue.put(event(1, event_state::cleared), false, 12 * kSecond_us);
  EXPECT_EQ(queue.take(12 * kSecond_us).value_or(event_t{}).state, event_state::cleared);
  EXPECT_FALSE(queue.take(100 * kSecond_us));
}

TEST(ActionQueue, NotifiesOfAnUnreportedEventAsRaised) {
  ActionQueue queue;
  queue.configure({});
  queue.put(event(1), false, 0);
  queue.put(event(1, event_state::changed), false, 0);
  EXPECT_EQ(queue.take(0).value_or(event_t{}).state, event_state::raised);
}

TEST(ActionQueue, LimitsNotificationsPerMinuteMostSevereFirst) {
  ActionQueue queue;
  ActionSettings settings;
  settings.per_minute = 3;
  queue.configure(settings);
  for (int id = 1; id <= 6; ++id)
    queue.put(event(id, event_state::raised, id < 5 ? severity::warning : severity::alarm), false,
              0);
  EXPECT_EQ(ids(queue, 0), (std::vector<std::int64_t>{5, 6, 1}));
  EXPECT_TRUE(ids(queue, 19 * kSecond_us).empty());
  EXPECT_EQ(ids(queue, 20 * kSecond_us), std::vector<std::int64_t>{2});
  EXPECT_EQ(ids(queue, 600 * kSecond_us), (std::vector<std::int64_t>{3, 4}));
}

TEST(ActionQueue, IsBoundedAndDropsTheLeastSevere) {
  ActionQueue queue;
  queue.configure({});
  int lost = queue.put(event(0, event_state::raised, severity::warning), false, 0);
  for (std::size_t i = 1; i <= 2 * ActionQueue::kMax; ++i)
    lost += queue.put(event(static_cast<std::int64_t>(i)), false, 0);
  EXPECT_EQ(queue.waiting(), ActionQueue::kMax);
  EXPECT_EQ(lost, static_cast<int>(ActionQueue::kMax) + 1);
  EXPECT_EQ(queue.take(0).value_or(event_t{}).id, 1);
}

TEST(ActionQueue, AtTheEndTheMostSevereEventsGoFirst) {
  ActionQueue queue;
  queue.configure({});
  queue.put(event(1, event_state::raised, severity::warning), false, 0);
  queue.put(event(2), false, 0);
  queue.put(event(3), false, 0);
  for (const std::int64_t id : {2, 3, 1}) EXPECT_EQ(queue.take_any().value_or(event_t{}).id, id);
  EXPECT_FALSE(queue.take_any());
}

TEST(ActionQueue, KeepsSilentAboutAcknowledgedEventsUntilTheirEnd) {
  ActionQueue queue;
  queue.configure({});
  queue.put(event(1), true, 0);
  queue.delivered_before(event(2));
  queue.put(event(2, event_state::changed), true, 0);
  EXPECT_EQ(queue.waiting(), 0u);
  queue.put(event(2, event_state::cleared), false, 0);
  EXPECT_EQ(ids(queue, 0), std::vector<std::int64_t>{2});
}

TEST(ActionQueue, DropsWaitingNotificationsOfAcknowledgedEvents) {
  ActionQueue queue;
  queue.configure({});
  queue.put(event(1), false, 0);
  queue.acknowledged(event(1));
  EXPECT_EQ(queue.waiting(), 0u);
  queue.put(event(1, event_state::cleared), false, 0);
  EXPECT_EQ(ids(queue, 0), std::vector<std::int64_t>{1});
}

}  // namespace action_queue_test

}  // namespace framewatch::daemon
