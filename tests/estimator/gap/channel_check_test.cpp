// SPDX-License-Identifier: MIT
// A channel that misreads is told from a building that changed, by a model that runs beside both.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <gtest/gtest.h>

#include "estimator/gap/base_response.h"
#include "estimator/gap/gap_monitor.h"
#include "estimator/gap/measured_inputs.h"
#include "estimator/numeric/nan.h"
#include "estimator/simulate/random.h"
#include "estimator/state/archive.h"
#include "tests/support/paper_buildings.h"
#include "tests/support/pipeline_run.h"

namespace framewatch::estimator {
namespace channel_check_test {

constexpr double kRate_hz = 100, kNoise_ratio = 0.005;
constexpr int kFault = 10000;  // instant
constexpr double kSeconds = 150, kSoon_s = 10;

struct Named {
  double after_s;  // since the fault
  int axis;
  AlarmState state;
  ChannelLaw law;
};

class FaultyChannel : public testing::Test {
 protected:
  FaultyChannel() : config_(test::pipeline_config(building_, kRate_hz)) {
    config_.options.rate_hz = kRate_hz;
    accel_ = test::shaken(building_, theta_, kRate_hz, kSeconds, kNoise_ratio);
  }

  /// Feeds the instants from..to - 1 to a monitor.
  std::vector<Named> run(GapMonitor& monitor, const Eigen::MatrixXd& accel, Eigen::Index from = 0,
                         Eigen::Index to = 1'000'000) const {
    std::vector<Named> out;
    for (Eigen::Index i = from; i < std::min(to, accel.rows()); ++i) {
      SampleSet set{from_microseconds(10'000 * i), i, std::vector<double>(config_.axes.size())};
      for (std::size_t a = 0; a < set.accel.size(); ++a)
        set.accel[a] = accel(i, static_cast<Eigen::Index>(a));
      (void)monitor.push(set, {});
      for (const ChannelNews& n : monitor.channel_news())
        out.push_back({seconds_of(n.found) - kFault / kRate_hz, n.axis, n.state, n.law});
    }
    return out;
  }
  GapMonitor monitor() const { return GapMonitor(config_, config_.axes, {}, GapModel{theta_, {}}); }
  std::vector<Named> run(const Eigen::MatrixXd& accel) const {
    GapMonitor m = monitor();
    return run(m, accel);
  }
  /// Returns the readings with a fault: `change` gets the readings from the fault on.
  Eigen::MatrixXd with(const std::function<void(Eigen::Block<Eigen::MatrixXd>)>& change) const {
    Eigen::MatrixXd out = accel_;
    change(out.bottomRows(out.rows() - kFault));
    return out;
  }
  int axis(int story, Direction along) const {
    for (std::size_t a = 0; a < config_.axes.size(); ++a)
      if (config_.axes[a].story == story && direction_of(building_, config_.axes[a]) == along)
        return static_cast<int>(a);
    return -1;
  }

  const Structure building_ = test::table1();
  const Eigen::VectorXd theta_ = test::table1_theta();
  PipelineConfig config_;
  Eigen::MatrixXd accel_;
};

/// Expects that the axis, and no other one, is named soon; returns its last law.
ChannelLaw expect_named(const std::vector<Named>& named, int axis, double soon_s = kSoon_s) {
  EXPECT_FALSE(named.empty());
  if (named.empty()) return {};
  EXPECT_LE(named.front().after_s, soon_s);
  EXPECT_GE(named.front().after_s, 0);
  for (const Named& n : named) EXPECT_EQ(n.axis, axis);
  return named.back().law;
}

TEST_F(FaultyChannel, OfAFloorIsNamedWithItsLaw) {
  for (const int story : {1, 5}) {
    const int at = axis(story, Direction::x);
    const ChannelLaw gain = expect_named(run(with([&](auto rows) { rows.col(at) *= 1.1; })), at);
    EXPECT_EQ(gain.fault, ChannelFault::gain);
    EXPECT_NEAR(gain.value, 1.1, 0.005);
    const ChannelLaw late = expect_named(run(with([&](auto rows) {
                                           for (Eigen::Index i = rows.rows() - 1; i > 2; --i)
                                             rows(i, at) = rows(i - 2, at);
                                         })),
                                         at);
    EXPECT_EQ(late.fault, ChannelFault::late);
    EXPECT_NEAR(late.value, 0.02, 0.001);
    const ChannelLaw dead = expect_named(run(with([&](auto rows) { rows.col(at) *= 1e-6; })), at);
    EXPECT_EQ(dead.fault, ChannelFault::only_noise);
    const int other = at + 1;
    const ChannelLaw repeats =
        expect_named(run(with([&](auto rows) { rows.col(at) = rows.col(other); })), at);
    EXPECT_EQ(repeats.fault, ChannelFault::repeats);
    EXPECT_EQ(repeats.other, other);
  }
}

TEST_F(FaultyChannel, OfTheBaseIsNamedAlthoughTheWholeModelMovesWrongly) {
  const int base = axis(0, Direction::y);
  ASSERT_GE(base, 0);
  constexpr double kDiesAway_s = 15;  // the motion before the fault, at 1 % of critical damping
  const ChannelLaw gain =
      expect_named(run(with([&](auto rows) { rows.col(base) *= 1.2; })), base, kDiesAway_s);
  EXPECT_EQ(gain.fault, ChannelFault::gain);
  EXPECT_NEAR(gain.value, 1.2, 0.02);
  const ChannelLaw dead = expect_named(run(with([&](auto rows) { rows.col(base) *= 1e-6; })), base);
  EXPECT_EQ(dead.fault, ChannelFault::only_noise);
}

TEST_F(FaultyChannel, OfTheBaseIsNamedByFaultsOfTime) {
  const int base = axis(0, Direction::x);
  const ChannelLaw late = expect_named(run(with([&](auto rows) {
                                         for (Eigen::Index i = rows.rows() - 1; i > 3; --i)
                                           rows(i, base) = rows(i - 3, base);
                                       })),
                                       base);
  EXPECT_EQ(late.fault, ChannelFault::late);
  EXPECT_NEAR(late.value, 0.03, 0.002);
  const ChannelLaw slow = expect_named(run(with([&](auto rows) {
                                         for (Eigen::Index i = 1; i < rows.rows(); ++i)
                                           rows(i, base) =
                                               0.8 * rows(i - 1, base) + 0.2 * rows(i, base);
                                       })),
                                       base);
  EXPECT_EQ(slow.fault, ChannelFault::bandwidth);
}

TEST_F(FaultyChannel, ThatIsExchangedWithTheBaseNamesBoth) {
  const int base = axis(0, Direction::x), roof = axis(5, Direction::x);
  const std::vector<Named> named = run(with([&](auto rows) {
    const Eigen::VectorXd kept = rows.col(base);
    rows.col(base) = rows.col(roof);
    rows.col(roof) = kept;
  }));
  ASSERT_GE(named.size(), 2u);
  EXPECT_LE(named[1].after_s, kSoon_s);
  EXPECT_NE(named[0].axis, named[1].axis);
  for (const Named& n : named) {
    EXPECT_EQ(n.law.fault, ChannelFault::exchanged);
    EXPECT_EQ(n.axis + n.law.other, base + roof);
  }
}

TEST_F(FaultyChannel, ThatIsExchangedNamesBoth) {
  const int one = axis(2, Direction::x), two = axis(4, Direction::x);
  const std::vector<Named> named = run(with([&](auto rows) {
    const Eigen::VectorXd kept = rows.col(one);
    rows.col(one) = rows.col(two);
    rows.col(two) = kept;
  }));
  std::vector<int> axes;
  for (const Named& n : named) {
    EXPECT_EQ(n.law.fault, ChannelFault::exchanged);
    axes.push_back(n.axis);
  }
  EXPECT_NE(std::find(axes.begin(), axes.end(), one), axes.end());
  EXPECT_NE(std::find(axes.begin(), axes.end(), two), axes.end());
}

TEST_F(FaultyChannel, IsNotSeenInABuildingThatLosesStiffness) {
  ASSERT_TRUE(run(accel_).empty());
  const ParameterTable table(building_);
  for (int p = 0; p < table.elements(); ++p) {
    if (table[p].kind != ParameterKind::frame_stiffness || p % 3 != 0) continue;
    for (const double loss : {0.05, 0.2}) {
      Eigen::VectorXd damaged = theta_;
      damaged[p] *= 1 - loss;
      Eigen::MatrixXd accel = accel_;
      accel.bottomRows(accel.rows() - kFault) =
          test::shaken(building_, damaged, kRate_hz, kSeconds, kNoise_ratio)
              .bottomRows(accel.rows() - kFault);
      EXPECT_TRUE(run(accel).empty()) << table[p].name << " " << loss;
    }
  }
}

TEST_F(FaultyChannel, IsTrustedAgainWhenItReadsRight) {
  const int at = axis(3, Direction::y);
  const std::vector<Named> named = run(with([&](auto rows) { rows.col(at).head(1000) *= 1.3; }));
  ASSERT_GE(named.size(), 2u);
  EXPECT_EQ(named.back().state, AlarmState::cleared);
  EXPECT_EQ(named.back().axis, at);
}

TEST_F(FaultyChannel, IsTheSameAfterARestart) {
  const int at = axis(3, Direction::y);
  const Eigen::MatrixXd accel = with([&](auto rows) { rows.col(at) *= 0.9; });
  GapMonitor whole = monitor();
  const std::vector<Named> expected = run(whole, accel);
  for (const Eigen::Index cut : {9990, 10130, 10620}) {
    GapMonitor before = monitor(), after = monitor();
    std::vector<Named> named = run(before, accel, 0, cut);
    StateWriter writer;
    writer(before);
    StateReader reader(writer.bytes());
    reader(after);
    ASSERT_TRUE(reader.whole()) << cut;
    EXPECT_EQ(after.doubted(), before.doubted());
    for (const Named& n : run(after, accel, cut)) named.push_back(n);
    ASSERT_EQ(named.size(), expected.size()) << cut;
    for (std::size_t i = 0; i < named.size(); ++i) {
      EXPECT_EQ(named[i].after_s, expected[i].after_s);
      EXPECT_EQ(named[i].law.value, expected[i].law.value);
    }
  }
}

}  // namespace channel_check_test
}  // namespace framewatch::estimator
