#include <framewatch/event_t.hpp>

#include "daemon/monitor/actions/notifier.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/daemon/monitor/actions/example_event.h"

namespace framewatch::daemon {
namespace action_queue_test {

std::vector<std::int64_t> ids(ActionQueue& queue, std::int64_t now_us) {
  std::vector<std::int64_t> out;
  while (const auto e = queue.take(now_us)) out.push_back(e->id);
  return out;
}

TEST(ActionQueue, TellsWhatIsSevereEnoughAndThatItIsOver) {
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

TEST(ActionQueue, TellsWhatBeginsAndEndsAtOnce) {
  ActionQueue queue;
  queue.configure({});
  event_t e = event(1, event_state::cleared);
  e.since_us = e.time_us;
  queue.put(e, false, 0);
  EXPECT_EQ(queue.waiting(), 1u);
}

TEST(ActionQueue, OfChangesOnlyTheNewestIsToldAndNotAtOnce) {
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

TEST(ActionQueue, WhatNobodyWasToldIsToldAsRaised) {
  ActionQueue queue;
  queue.configure({});
  queue.put(event(1), false, 0);
  queue.put(event(1, event_state::changed), false, 0);
  EXPECT_EQ(queue.take(0).value_or(event_t{}).state, event_state::raised);
}

TEST(ActionQueue, TellsNoMoreThanSoManyInAMinuteTheMostSevereFirst) {
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

TEST(ActionQueue, IsBoundedAndLosesTheLeastSevere) {
  ActionQueue queue;
  queue.configure({});
  int lost = queue.put(event(0, event_state::raised, severity::warning), false, 0);
  for (std::size_t i = 1; i <= 2 * ActionQueue::kMax; ++i)
    lost += queue.put(event(static_cast<std::int64_t>(i)), false, 0);
  EXPECT_EQ(queue.waiting(), ActionQueue::kMax);
  EXPECT_EQ(lost, static_cast<int>(ActionQueue::kMax) + 1);
  EXPECT_EQ(queue.take(0).value_or(event_t{}).id, 1);
}

TEST(ActionQueue, WhatSomebodyKnowsIsNotToldAgainUntilItIsOver) {
  ActionQueue queue;
  queue.configure({});
  queue.put(event(1), true, 0);
  queue.delivered_before(event(2));
  queue.put(event(2, event_state::changed), true, 0);
  EXPECT_EQ(queue.waiting(), 0u);
  queue.put(event(2, event_state::cleared), false, 0);
  EXPECT_EQ(ids(queue, 0), std::vector<std::int64_t>{2});
}

TEST(ActionQueue, WhatWaitsIsNotToldAnyMoreWhenSomebodyKnows) {
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
