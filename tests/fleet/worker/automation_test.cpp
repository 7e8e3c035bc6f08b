// SPDX-License-Identifier: MIT
#include "fleet/worker/automation.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <framewatch/service_t.hpp>

#include "tests/fleet/worker/worker_fixture.h"

namespace framewatch::fleet {
namespace automation_test {

using nlohmann::json;

ReceivedNewest heartbeat(const std::vector<std::pair<std::int64_t, std::int32_t>>& raised) {
  service_t s{};
  s.time_us = kHub_us;
  s.raised = static_cast<std::int32_t>(raised.size());
  for (const auto& [id, severity] : raised) {
    s.event_id.push_back(id);
    s.event_since_us.push_back(1);
    s.event_severity.push_back(severity);
    s.event_kind.push_back("gap");
    s.event_place.push_back("roof");
    s.event_message.push_back("it \"moves\"");
  }
  return {"kobe", "service", "service_t", drivers::encoded(s)};
}

json content(const Message& message) {
  return json::parse(message.bytes.begin(), message.bytes.end(), nullptr, false);
}

TEST(Automation, PublishesABuildingsStateFromItsHeartbeat) {
  FleetBatch batch;
  batch.newest = {heartbeat({{1, 2}}), heartbeat({{3, 1}, {4, 2}, {5, 0}})};
  const auto messages = automation_messages(batch);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].subject, "framewatch.kobe.state");
  const json state = content(messages[0]);
  EXPECT_EQ(state["schema"], "framewatch.state/1");
  EXPECT_EQ(state["building"], "kobe");
  EXPECT_EQ(state["severity"], "alarm");
  EXPECT_EQ(state["raised_count"], 3);
  EXPECT_EQ(state["raised"][0]["id"], 4);
  EXPECT_EQ(state["raised"][0]["message"], "it \"moves\"");
}

TEST(Automation, PublishesThatNothingIsRaised) {
  FleetBatch batch;
  batch.newest = {heartbeat({})};
  EXPECT_EQ(content(automation_messages(batch).at(0))["severity"], "none");
}

TEST(Automation, PublishesAnEventAsForAWebhook) {
  FleetBatch batch;
  batch.events = {{"kobe", event(7)}};
  const auto messages = automation_messages(batch);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].subject, "framewatch.kobe.event");
  EXPECT_EQ(content(messages[0])["schema"], "framewatch.event/1");
}

TEST(Automation, IgnoresUnreadableMessages) {
  FleetBatch batch;
  batch.newest = {{"kobe", "service", "service_t", {1, 2, 3}}, {"kobe", "config", "toml", {'a'}}};
  EXPECT_TRUE(automation_messages(batch).empty());
}

TEST(Automation, CountsManyFindings) {
  std::vector<std::pair<std::int64_t, std::int32_t>> many;
  for (int i = 0; i < 1000; ++i) many.emplace_back(i, 1);
  FleetBatch batch;
  batch.newest = {heartbeat(many)};
  const json state = content(automation_messages(batch).at(0));
  EXPECT_EQ(state["raised_count"], 1000);
  EXPECT_EQ(state["raised"].size(), 100u);
}

}  // namespace automation_test
}  // namespace framewatch::fleet
