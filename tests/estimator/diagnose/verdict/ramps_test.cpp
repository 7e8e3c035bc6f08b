// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/verdict.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace ramps_test {

using test::Recorded;

constexpr int kChannel = 1;
constexpr double kRamp_mps3 = 0.05, kFrom_s = 6;
constexpr double kSlopeOff = 0.15, kFromOff_s = 2.5;

/// Returns two records, each followed by some seconds of noise, because a ramp needs that length.
std::vector<Eigen::MatrixXd> long_records() {
  constexpr Eigen::Index kMore = 16 * static_cast<Eigen::Index>(test::kRate_hz);
  Random random(9);
  std::vector<Eigen::MatrixXd> out = test::records_with({}, {1, 2});
  for (Eigen::MatrixXd& record : out) {
    const Eigen::Index rows = record.rows();
    record.conservativeResize(rows + kMore, Eigen::NoChange);
    for (double& a : record.bottomRows(kMore).reshaped()) a = test::kNoise_mps2 * random.normal();
  }
  return out;
}

/// Returns such records with a rising reading in the second.
std::vector<Eigen::MatrixXd> records_with_ramp() {
  std::vector<Eigen::MatrixXd> out = long_records();
  for (Eigen::Index i = 0; i < out[1].rows(); ++i)
    out[1](i, kChannel) +=
        kRamp_mps3 * std::max(static_cast<double>(i) / test::kRate_hz - kFrom_s, 0.0);
  return out;
}

double off_of(const RecordSegment& a, const RecordSegment& b) {
  return (a.accel.col(kChannel) - b.accel.col(kChannel)).norm() / b.accel.col(kChannel).norm();
}

TEST(Ramps, AreFoundAndRemovedInTheirRecord) {
  const Recorded clean(long_records()), recorded(records_with_ramp());
  std::vector<RecordSegment> segments = recorded.segments;
  const std::vector<FoundEffect> found = remove_ramps(recorded.plant, {}, segments);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].chosen.kind, EffectKind::bias_drift);
  EXPECT_EQ(found[0].chosen.place, test::at_channel(kChannel));
  EXPECT_EQ(found[0].index, -1);
  EXPECT_DOUBLE_EQ(found[0].ramp_mps3[0], 0);
  EXPECT_NEAR(found[0].ramp_mps3[1] / kRamp_mps3, 1, kSlopeOff);
  EXPECT_NEAR(found[0].ramp_from_s[1], kFrom_s, kFromOff_s);
  EXPECT_EQ(segments[0].accel, recorded.segments[0].accel);
  EXPECT_LT(off_of(segments[1], clean.segments[1]),
            0.2 * off_of(recorded.segments[1], clean.segments[1]));
}

TEST(Ramps, AreNotFoundIfAbsentOrExcluded) {
  const Recorded clean(long_records()), recorded(records_with_ramp());
  std::vector<RecordSegment> segments = clean.segments;
  EXPECT_TRUE(remove_ramps(clean.plant, {}, segments).empty());
  DiagnosisOptions options;
  options.without = {EffectKind::bias_drift};
  segments = recorded.segments;
  EXPECT_TRUE(remove_ramps(recorded.plant, options, segments).empty());
  EXPECT_EQ(segments[1].accel, recorded.segments[1].accel);
}

TEST(Ramps, AKnownOneIsRemovedFromEveryRecord) {
  const Recorded clean({long_records()[1]}), recorded({records_with_ramp()[1]});
  DiagnosisOptions options;
  options.known = {
      test::effect_of(EffectKind::bias_drift, test::at_channel(kChannel), {kRamp_mps3, kFrom_s})};
  std::vector<RecordSegment> segments = recorded.segments;
  EXPECT_TRUE(remove_ramps(recorded.plant, options, segments).empty());
  EXPECT_LT(off_of(segments[0], clean.segments[0]), 1e-9);
}

TEST(Ramps, IncreaseTheInitialGapByTheirPower) {
  const Recorded recorded(test::records_with({}, {1, 2}));
  constexpr double kBefore = 0.01, kAfter = 0.008;
  const Eigen::Index axes = recorded.plant.axis_count();
  Gap gap;
  gap.axis = gap.floor = Eigen::VectorXd::Constant(axes, kBefore);
  gap.overall = gap.worst = kBefore;
  gap.worst_axis = 0;
  const RecordSegment& s = recorded.segments[1];
  // The base's axes, the last two, are not outputs.
  const Eigen::Index outputs = axes - 2;
  gap.measured_rms =
      std::sqrt(2 * s.spectrum.topRows(outputs).squaredNorm() / static_cast<double>(outputs)) /
      static_cast<double>(s.intervals());
  Diagnosis d;
  d.before = {gap, gap};
  gap.overall = kAfter;
  d.after = {gap, gap};
  d.effects.resize(2);
  FoundEffect& ramp = d.effects[0];
  ramp.chosen.place = test::at_channel(kChannel);
  ramp.ramp_mps3 = {0, kRamp_mps3};
  ramp.ramp_from_s = {0, kFrom_s};
  d.effects[1].before = 0.5;
  add_ramps_to_gaps(recorded.plant, recorded.segments, 1, d);
  // The mean square of the ramp around its mean, sample by sample, over that of the reading.
  Eigen::VectorXd rise(s.intervals());
  for (Eigen::Index i = 0; i < rise.size(); ++i)
    rise[i] = kRamp_mps3 * std::max(static_cast<double>(i) / s.rate_hz - kFrom_s, 0.0);
  const double square = (rise.array() - rise.mean()).square().mean();
  const auto reading = [&](Eigen::Index first, Eigen::Index count) {
    double out = 0;
    for (Eigen::Index a = first; a < first + count; ++a)
      out += signal_of(s.spectrum.row(a).transpose(), s, 1).squaredNorm() /
             static_cast<double>(s.intervals());
    return out;
  };
  constexpr double kOff = 0.01;
  const double of_axis = std::hypot(kBefore, std::sqrt(square / reading(kChannel, 1)));
  const double of_all = std::hypot(kBefore, std::sqrt(square / reading(0, outputs)));
  EXPECT_NEAR(d.before[1].axis[kChannel] / of_axis, 1, kOff);
  EXPECT_NEAR(d.before[1].overall / of_all, 1, kOff);
  EXPECT_EQ(d.before[1].worst_axis, kChannel);
  EXPECT_DOUBLE_EQ(d.before[0].overall, kBefore);
  // Its remaining gap is the one before the search; other effects keep theirs.
  EXPECT_DOUBLE_EQ(ramp.before, d.before[1].overall);
  EXPECT_DOUBLE_EQ(ramp.after, kBefore);
  EXPECT_DOUBLE_EQ(d.effects[1].before, 0.5);
}

}  // namespace ramps_test
}  // namespace framewatch::estimator
