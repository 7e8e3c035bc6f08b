// SPDX-License-Identifier: MIT
#include "fleet/view/overview.h"

#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace framewatch::fleet {
namespace overview_test {

constexpr std::int64_t kNow_us = 1'795'305'600'000'000;
constexpr std::int64_t kAlive_us = kNow_us - 60'000'000;
constexpr std::int64_t kLongAgo_us = kNow_us - BuildingState::kSilent_us - 1;

event_t event(std::int64_t id, std::int32_t severity, std::int32_t state = 1) {
  event_t e{};
  e.id = id;
  e.severity = severity;
  e.state = state;
  e.since_us = 100 + id;
  e.message = "event " + std::to_string(id);
  return e;
}

BuildingState heard(std::int64_t heard_us, std::vector<event_t> raised = {}) {
  BuildingState state;
  state.heard_us = heard_us;
  state.raised = std::move(raised);
  return state;
}

TEST(BuildingState, IsWellWithoutRaisedEvents) {
  const Judged j = judged(heard(kAlive_us), kNow_us);
  EXPECT_EQ(j.urgency, Urgency::well);
  EXPECT_EQ(j.message, "");
}

TEST(BuildingState, ShowsTheMostUrgentEvent) {
  BuildingState state = heard(kAlive_us, {event(1, 0), event(2, 2), event(3, 1)});
  EXPECT_EQ(judged(state, kNow_us).urgency, Urgency::alarm);
  EXPECT_EQ(judged(state, kNow_us).message, "event 2");
  EXPECT_EQ(judged(state, kNow_us).since_us, 102);
  state.known = {{2, "alice"}};
  EXPECT_EQ(judged(state, kNow_us).urgency, Urgency::warning);
  state.known = {{2, "alice"}, {3, "bob"}};
  EXPECT_EQ(judged(state, kNow_us).urgency, Urgency::changed);
  state.raised.erase(state.raised.begin());
  EXPECT_EQ(judged(state, kNow_us).urgency, Urgency::known);
}

TEST(BuildingState, RanksSilenceBetweenAlarmAndChange) {
  EXPECT_EQ(judged(heard(kLongAgo_us, {event(1, 2)}), kNow_us).urgency, Urgency::alarm);
  EXPECT_EQ(judged(heard(kLongAgo_us, {event(1, 0)}), kNow_us).urgency, Urgency::silent);
  EXPECT_EQ(judged(heard(kLongAgo_us), kNow_us).since_us, kLongAgo_us);
  EXPECT_FALSE(heard(kNow_us - BuildingState::kSilent_us).is_silent(kNow_us));
}

TEST(BuildingState, IsSilentWithoutAHeartbeatForLong) {
  BuildingState state;
  state.first_us = kAlive_us;
  EXPECT_EQ(judged(state, kNow_us).urgency, Urgency::well);
  state.first_us = kLongAgo_us;
  EXPECT_EQ(judged(state, kNow_us).message, "no heartbeat has come yet");
}

TEST(BuildingState, FollowsRaisedChangedAndClearedEvents) {
  std::vector<event_t> raised;
  note_event(raised, event(1, 1));
  note_event(raised, event(2, 2));
  note_event(raised, event(1, 2, 2));
  ASSERT_EQ(raised.size(), 2u);
  EXPECT_EQ(raised[0].severity, 2);
  note_event(raised, event(1, 0, 0));
  note_event(raised, event(7, 0, 0));
  ASSERT_EQ(raised.size(), 1u);
  EXPECT_EQ(raised[0].id, 2);
}

}  // namespace overview_test
}  // namespace framewatch::fleet
