// SPDX-License-Identifier: MIT
#include <framewatch/event_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/page/view/page_watch.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/monitor/events/change_words.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/page/findings/finding.h"
#include "estimator/numeric/nan.h"
#include "tests/support/config_fixture.h"

namespace framewatch::daemon {
namespace page_watch_test {

// Limits.
constexpr double kSecondsToTell = 4;  // from the drop to the event

constexpr double kStep_s = 0.1, kDropAt_s = 30, kBackAt_s = 90, kEnd_s = 150, kDrop_ratio = 0.15;
constexpr std::size_t kDropped = 1;

/// Returns the share of a window ending at `end_s` in which the frame is softer.
double softer_share(double end_s, double length_s) {
  const double from = std::max(end_s - length_s, kDropAt_s), to = std::min(end_s, kBackAt_s);
  return std::max(0.0, to - from) / length_s;
}

window_estimate_t estimate_at(double end_s, double length_s, const std::vector<double>& value,
                              double relative_error) {
  window_estimate_t e{};
  e.window_start_us = std::llround(1e6 * (end_s - length_s));
  e.window_end_us = std::llround(1e6 * end_s);
  e.parameters = static_cast<std::int32_t>(value.size());
  e.status = 1;
  e.value = value;
  for (const double v : value) e.std_error.push_back(relative_error * v);
  e.reason.assign(value.size(), 0);
  e.snr.assign(value.size(), 100);
  e.prior_share.assign(value.size(), 0);
  e.noise_share.assign(value.size(), 0);
  return e;
}

class PageWatchTest : public ::testing::Test {
 protected:
  /// Returns the configured lengths of the windows, the main one first.
  std::vector<double> lengths() const {
    std::vector<double> out{config_.pipeline.options.window_s};
    for (const double s : config_.pipeline.options.other_windows_s) out.push_back(s);
    return out;
  }
  estimator::ParameterTable table() const {
    return estimator::ParameterTable(config_.pipeline.structure);
  }
  std::vector<double> values() const {
    return std::vector<double>(static_cast<std::size_t>(table().size()), 20e3);
  }

  Config config_ = test::good(test::kGoodConfig);
};

TEST_F(PageWatchTest, NamesTheFrameThatLostStiffnessUntilItReturns) {
  PageWatch watch(config_, 7);
  std::vector<event_t> events;
  for (double t = 10; t < kEnd_s; t += kStep_s)
    for (std::size_t w = 0; w < lengths().size(); ++w) {
      std::vector<double> value = values();
      value[kDropped] *= 1 - kDrop_ratio * softer_share(t, lengths()[w]);
      value.back() *= t < kDropAt_s ? 1 : 2;  // damping, which is not watched
      for (const event_t& e :
           watch.observe(static_cast<int>(w), estimate_at(t, lengths()[w], value, 0.005)))
        events.push_back(e);
    }
  ASSERT_GE(events.size(), 2u);
  EXPECT_LE(static_cast<double>(events.front().time_us), 1e6 * (kDropAt_s + kSecondsToTell));
  double newest_value = 0;
  for (const event_t& e : events) {
    EXPECT_EQ(e.place, table()[kDropped].name);
    EXPECT_EQ(e.kind, "stiffness_change");
    EXPECT_EQ(e.unit, "%");
    // After its return, longer windows may still raise an alarm for a while.
    if (static_cast<double>(e.time_us) < 1e6 * kBackAt_s) {
      EXPECT_EQ(e.id, 7);
      if (std::isfinite(e.value)) newest_value = e.value / 100;
    }
  }
  EXPECT_EQ(events.front().state, event_state::raised);
  EXPECT_EQ(events.front().severity, severity::alarm);
  const auto sized = std::find_if(events.begin(), events.end(), [](const event_t& e) {
    return std::isfinite(e.value) && e.std_error > 0;
  });
  ASSERT_NE(sized, events.end());
  EXPECT_NE(sized->message.find(" of its stiffness, give or take "), std::string::npos);
  for (const event_t* e : {&events.front(), &*sized}) {
    std::string found = finding_of(*e, config_).text;
    found.pop_back();  // the sentence continues
    EXPECT_EQ(e->message.substr(0, found.size() + 8), found + ", since ");
  }
  EXPECT_EQ(events.back().state, event_state::cleared);
  EXPECT_EQ(events.back().message,
            named_place(table()[kDropped].name, {}) + " is at its baseline again");
  EXPECT_NEAR(newest_value, -kDrop_ratio, 0.03);
}

TEST_F(PageWatchTest, NoiseAndSilenceRaiseNothing) {
  PageWatch watch(config_, 1);
  for (int i = 0; i < 400; ++i) {
    std::vector<double> value = values();
    for (double& v : value) v *= 1 + 0.004 * std::sin(1.7 * i) * (i % 3 - 1);
    window_estimate_t e = estimate_at(10 + i, 5, value, 0.005);
    if (i % 50 > 30) {
      e.reason.assign(value.size(), 2);
      e.value.assign(value.size(), estimator::kNaN);
      e.std_error = e.value;
    }
    EXPECT_TRUE(watch.observe(0, e).empty()) << i;
  }
  EXPECT_NEAR(watch.baseline()[0], 20e3, 100);
}

TEST_F(PageWatchTest, TheBaselineHoldsOnlyStiffnessAndCanBeRenewed) {
  PageWatch watch(config_, 1);
  EXPECT_TRUE(std::isnan(watch.baseline()[0]));
  const auto learn = [&](double from_s, double scale) {
    std::vector<event_t> events;
    for (double t = from_s; t < from_s + 60; t += 1) {
      std::vector<double> value = values();
      value[0] *= scale;
      for (const event_t& e : watch.observe(0, estimate_at(t, 5, value, 0.005)))
        events.push_back(e);
    }
    return events;
  };
  EXPECT_TRUE(learn(10, 1).empty());
  EXPECT_NEAR(watch.baseline()[0], 20e3, 1);
  EXPECT_TRUE(std::isnan(watch.baseline().back()));
  const std::vector<event_t> softer = learn(70, 0.8);
  ASSERT_FALSE(softer.empty());
  watch.renew();
  EXPECT_TRUE(std::isnan(watch.baseline()[0]));
  EXPECT_TRUE(learn(130, 0.8).empty());
  const std::vector<event_t> again = learn(190, 1);
  ASSERT_FALSE(again.empty());
  EXPECT_GT(again.front().id, softer.front().id);
}

TEST_F(PageWatchTest, IgnoresEstimatesOfAnotherBuilding) {
  PageWatch watch(config_, 1);
  EXPECT_TRUE(watch.observe(0, estimate_at(10, 5, {1, 2}, 0.005)).empty());
}

}  // namespace page_watch_test
}  // namespace framewatch::daemon
