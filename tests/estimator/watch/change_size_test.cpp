// SPDX-License-Identifier: MIT
#include "estimator/watch/change_size.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/watch/watch.h"

namespace framewatch::estimator {
namespace change_size_test {

constexpr double kError = 0.01;

TEST(ChangeSize, IsTheWeightedMeanAndGetsMoreExact) {
  ChangeSize size;
  EXPECT_FALSE(size.known());
  size.push(-0.10, 0.01);
  size.push(-0.13, 0.02);
  EXPECT_NEAR(size.ratio(), (-0.10 - 0.13 / 4) / 1.25, 1e-12);
  // Two windows 0.03 apart scatter by 1.8 times what 0.01 and 0.02 explain.
  const double excess = (ChangeSize::kPriorWindows + 1.8) / (ChangeSize::kPriorWindows + 1);
  EXPECT_NEAR(size.std_error(), 0.01 * std::sqrt(excess / 1.25), 1e-12);
}

TEST(ChangeSize, CommonErrorsOfWindowsRemain) {
  ChangeSize size;
  for (int i = 0; i < 100; ++i) size.push(-0.1, kError, 0.05);
  EXPECT_NEAR(size.ratio(), -0.1, 1e-9);
  EXPECT_GT(size.std_error(), 0.05);
  EXPECT_LT(size.std_error(), 0.051);
  for (int i = 0; i < 100; ++i) size.push(-0.15, kError, 0.001);
  EXPECT_NEAR(size.ratio(), -0.15, 0.003);  // the more exact one counts more
  EXPECT_LT(size.std_error(), 0.005);
}

TEST(ChangeSize, LeavesOutOneWildWindowAndFollowsTwo) {
  ChangeSize size;
  for (int i = 0; i < 20; ++i) size.push(-0.1, kError);
  size.push(-0.4, kError);
  size.push(-0.1, kError);
  size.push(0.2, kError);
  size.push(-0.4, kError);  // on the other side: not two in a row
  EXPECT_NEAR(size.ratio(), -0.1, 1e-9);
  size.push(-0.4, kError);
  EXPECT_NEAR(size.ratio(), -0.4, 1e-9);
}

/// An alarm of short windows whose size then comes from the main ones.
TEST(ChangeSize, AnAlarmIsReportedAgainAsItsErrorShrinks) {
  constexpr double kChange = -0.15, kFrom_s = 100, kEnd_s = 400, kShrinks = 2.5;
  constexpr SensorClock::duration kSame{2'500'000};  // the instant is refined
  constexpr std::size_t kMaxNews = 12;
  Structure s;
  s.stories = 1;
  s.frames_x = {"y1"};
  s.story_height = {1};
  s.node_mass = {1};
  const ParameterTable table(s);
  const std::vector<double> lengths_s = {5, 1};
  Baseline baseline(static_cast<std::size_t>(table.size()));
  baseline.value.assign(baseline.value.size(), 1.0);
  baseline.std_error.assign(baseline.std_error.size(), 0.0005);
  WatchOptions options;
  options.quiet_window_s = 0;
  Watch watch(table, options, lengths_s, baseline);
  Random random(7);
  std::vector<Alarm> news;
  for (double t = 10; t < kEnd_s; t += 0.2)
    for (std::size_t w = 0; w < lengths_s.size(); ++w) {
      WindowEstimate e(static_cast<std::size_t>(table.size()));
      e.window = static_cast<int>(w);
      e.end = from_microseconds(std::llround(1e6 * t));
      e.start = from_microseconds(std::llround(1e6 * (t - lengths_s[w])));
      e.status = WindowStatus::valid;
      const double after = std::min(1.0, std::max(0.0, (t - kFrom_s) / lengths_s[w]));
      const double error = kError / std::sqrt(lengths_s[w] / lengths_s[1]);
      e.value.assign(e.value.size(), 1 + kChange * after + error * random.normal());
      e.std_error.assign(e.value.size(), error);
      e.prior_share.assign(e.value.size(), 0);
      e.noise_share.assign(e.value.size(), 0);
      e.reason.assign(e.value.size(), Observability::observable);
      for (const Alarm& alarm : watch.push(e)) news.push_back(alarm);
    }
  ASSERT_GE(news.size(), 2u);
  EXPECT_LE(news.size(), kMaxNews);
  EXPECT_EQ(news.front().state, AlarmState::raised);
  const Change first = news.front().change, last = news.back().change;
  EXPECT_EQ(news.back().state, AlarmState::changed);
  EXPECT_LT(std::chrono::abs(last.since - first.since), kSame);
  EXPECT_LT(last.std_error, first.std_error / kShrinks);
  EXPECT_NEAR(last.ratio, kChange, 4 * last.std_error);
}

}  // namespace change_size_test
}  // namespace framewatch::estimator
