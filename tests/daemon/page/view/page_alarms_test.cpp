// SPDX-License-Identifier: MIT
// The page shows the events that `framewatch run` raises, and those of the page itself.
#include "daemon/page/view/page_alarms.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "daemon/monitor/events/event_messages.h"
#include "tests/support/config_fixture.h"

namespace framewatch::daemon {
namespace page_alarms_test {

event_t event(std::int64_t id, const std::string& kind = "gap") {
  event_t e{};
  e.id = id;
  e.since_us = 10 * id;
  e.state = event_state::raised;
  e.severity = severity::alarm;
  e.kind = kind;
  e.place = "F1-Y1";
  e.message = "they differ";
  return e;
}

service_t report(const std::vector<std::int64_t>& ids) {
  service_t s{};
  s.time_us = 99;
  for (const std::int64_t id : ids) {
    s.event_id.push_back(id);
    s.event_since_us.push_back(10 * id);
    s.event_severity.push_back(severity::alarm);
    s.event_kind.push_back("gap");
    s.event_place.push_back("F1-Y1");
    s.event_message.push_back("they differ");
  }
  s.raised = static_cast<std::int32_t>(ids.size());
  return s;
}

/// Acknowledges everything at a time of the host's clock, and these events of `run`.
acknowledged_t all_at(std::int64_t time_us, const std::vector<std::int64_t>& ids) {
  acknowledged_t out{};
  for (const std::int64_t id : ids) add_acknowledged(out, event(id), {time_us, "me", ""});
  if (time_us != 0) add_all_acknowledged(out, {time_us, "me", "seen"});
  return out;
}

class PageAlarmsTest : public testing::Test {
 protected:
  std::vector<std::int64_t> shown() const {
    std::vector<std::int64_t> out;
    for (const Finding& f : alarms_.findings(config_)) out.push_back(f.id);
    return out;
  }
  std::size_t open() const {
    const std::vector<Finding> all = alarms_.findings(config_);
    return static_cast<std::size_t>(
        std::count_if(all.begin(), all.end(), [](const Finding& f) { return !f.acknowledged; }));
  }

  Config config_ = test::good(test::kGoodConfig);
  PageAlarms alarms_;
  using Ids = std::vector<std::int64_t>;
};

TEST_F(PageAlarmsTest, ClosesEventsThatRunNoLongerRaises) {
  (void)alarms_.note(event(1));
  (void)alarms_.note(event(2));
  EXPECT_EQ(alarms_.still_raised(report({1, 2})).size(), 0u);
  EXPECT_EQ(shown(), (Ids{1, 2}));
  // `run` restarted with a state from before the second event.
  const std::vector<std::string> news = alarms_.still_raised(report({1, 3}));
  EXPECT_EQ(news.size(), 2u);
  EXPECT_EQ(shown(), (Ids{1, 3}));
  ASSERT_NE(alarms_.find(2), nullptr);
  EXPECT_EQ(alarms_.find(2)->state, event_state::cleared);
  EXPECT_NE(alarms_.find(2)->message.find("no longer reports"), std::string::npos);
  EXPECT_EQ(alarms_.still_raised(report({1, 3})).size(), 0u);
  // `run` raises it again.
  (void)alarms_.note(event(2));
  EXPECT_EQ(shown(), (Ids{1, 2, 3}));
}

TEST_F(PageAlarmsTest, KeepsEventsThatThePageFound) {
  (void)alarms_.note_own(event(7, "stiffness_change"));
  EXPECT_EQ(alarms_.still_raised(report({})).size(), 0u);
  EXPECT_EQ(shown(), Ids{7});
}

TEST_F(PageAlarmsTest, AcknowledgeAllCoversEveryShownEvent) {
  (void)alarms_.note(event(1));
  (void)alarms_.note_own(event(7, "stiffness_change"));
  (void)alarms_.acknowledged(all_at(0, {}));
  EXPECT_EQ(open(), 2u);
  EXPECT_EQ(alarms_.acknowledged(all_at(5, {1})).size(), 2u);
  EXPECT_EQ(open(), 0u);
  EXPECT_EQ(alarms_.findings(config_)[1].who, "me");
  // Later events are not acknowledged.
  (void)alarms_.note_own(event(8, "stiffness_change"));
  (void)alarms_.acknowledged(all_at(5, {1, 2}));
  EXPECT_EQ(open(), 1u);
  (void)alarms_.acknowledged(all_at(6, {1, 2}));
  EXPECT_EQ(open(), 0u);
}

TEST_F(PageAlarmsTest, AnEarlierAcknowledgementDoesNotCoverThePagesOwnEvents) {
  (void)alarms_.note_own(event(7, "stiffness_change"));
  (void)alarms_.acknowledged(all_at(5, {}));
  EXPECT_EQ(open(), 1u);
}

}  // namespace page_alarms_test
}  // namespace framewatch::daemon
