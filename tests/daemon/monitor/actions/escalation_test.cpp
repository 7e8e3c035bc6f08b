// SPDX-License-Identifier: MIT
#include "daemon/monitor/actions/escalation.h"

#include <gtest/gtest.h>

#include "daemon/monitor/events/event_messages.h"
#include "tests/daemon/monitor/actions/example_event.h"

namespace framewatch::daemon {
namespace escalation_test {

constexpr std::int64_t kMinute_us = 60 * kSecond_us;

class EscalationTest : public testing::Test {
 protected:
  EscalationTest() { escalation_.configure(3, 30); }
  Escalation escalation_;
};

TEST_F(EscalationTest, TellsOneReceiverAfterTheOther) {
  EXPECT_EQ(escalation_.event(event(1), false, 0), 1u);
  EXPECT_TRUE(escalation_.due(severity::information, 30 * kMinute_us - 1).empty());
  auto due = escalation_.due(severity::information, 30 * kMinute_us);
  ASSERT_EQ(due.size(), 1u);
  EXPECT_EQ(due[0].receiver, 1u);
  EXPECT_EQ(due[0].event.message, event(1).message + " (not acknowledged for 30 min)");
  EXPECT_EQ(escalation_.event(event(1, event_state::changed), false, 31 * kMinute_us), 2u);
  EXPECT_TRUE(escalation_.due(severity::information, 60 * kMinute_us - 1).empty());
  due = escalation_.due(severity::information, 60 * kMinute_us);
  ASSERT_EQ(due.size(), 1u);
  EXPECT_EQ(due[0].receiver, 2u);
  EXPECT_EQ(due[0].event.state, event_state::raised);
  EXPECT_TRUE(escalation_.due(severity::information, 600 * kMinute_us).empty());
  EXPECT_EQ(escalation_.event(event(1, event_state::cleared), false, 0), 3u);
}

TEST_F(EscalationTest, AnAcknowledgedOrClearedEventGoesNoFurther) {
  escalation_.event(event(1), false, 0);
  escalation_.event(event(2), false, 0);
  escalation_.event(event(3), false, 0);
  escalation_.acknowledged(event(1));
  escalation_.event(event(2, event_state::cleared), false, 1);
  const auto due = escalation_.due(severity::information, 30 * kMinute_us);
  ASSERT_EQ(due.size(), 1u);
  EXPECT_EQ(due[0].event.id, 3);
}

TEST_F(EscalationTest, MomentaryEventsGoToTheFirstReceiver) {
  event_t e = event(1, event_state::cleared);
  e.since_us = e.time_us;
  EXPECT_EQ(escalation_.event(e, false, 0), 1u);
  EXPECT_TRUE(escalation_.due(severity::information, 600 * kMinute_us).empty());
}

TEST_F(EscalationTest, TheTimeOfAnEventBeginsAfterQuietHours) {
  escalation_.event(event(1, event_state::raised, severity::warning), false, 0);
  EXPECT_TRUE(escalation_.due(severity::alarm, 100 * kMinute_us).empty());
  EXPECT_TRUE(escalation_.due(severity::information, 130 * kMinute_us - 1).empty());
  EXPECT_EQ(escalation_.due(severity::information, 130 * kMinute_us).size(), 1u);
}

TEST_F(EscalationTest, WithoutAnOrderAllAreToldAtOnce) {
  escalation_.configure(1, 30);
  EXPECT_EQ(escalation_.event(event(1), false, 0), 1u);
  EXPECT_TRUE(escalation_.due(severity::information, 600 * kMinute_us).empty());
}

TEST_F(EscalationTest, RemembersABoundedNumberOfEvents) {
  for (std::size_t i = 0; i < Escalation::kMax + 5; ++i)
    escalation_.event(event(static_cast<std::int64_t>(i)), false, static_cast<std::int64_t>(i));
  const auto due = escalation_.due(severity::information, 600 * kMinute_us);
  ASSERT_EQ(due.size(), Escalation::kMax);
  for (const auto& d : due) EXPECT_GE(d.event.id, 5);
}

}  // namespace escalation_test
}  // namespace framewatch::daemon
