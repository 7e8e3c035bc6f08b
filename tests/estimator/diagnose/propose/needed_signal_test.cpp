// SPDX-License-Identifier: MIT
#include <cmath>

#include <complex>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/simulate/random.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace needed_signal_test {

using Complex = std::complex<double>;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using test::Recorded;

constexpr int kFrame = 2, kOther = 0;
// Relative error of forces, because the frame's stiffness and damping are fitted too.
constexpr double kForceOff = 0.05;

/// Returns the share of a signal that linear elements and these columns leave, without noise.
double left_of(const NeededSignal& needed, const VectorXd& w, const std::vector<VectorXcd>& more) {
  std::vector<VectorXcd> columns = linear_columns(needed, w);
  const double before = scalar_fit({needed}, {columns}).misfit;
  columns.insert(columns.end(), more.begin(), more.end());
  return (scalar_fit({needed}, {columns}).misfit) / before;
}

TEST(NeededSignal, WeightIsTheInverseVariance) {
  const Recorded recorded(test::records_with({}, {1, 2}));
  const std::vector<NeededSignal> needed =
      needed_signals(recorded.fitter, recorded.freed(test::in_frame(kFrame)));
  ASSERT_EQ(needed.size(), recorded.segments.size());
  for (std::size_t r = 0; r < needed.size(); ++r) {
    EXPECT_EQ(needed[r].force.size(), recorded.segments[r].bins());
    EXPECT_TRUE(needed[r].force.allFinite());
    EXPECT_GT(needed[r].weight.minCoeff(), 0);
  }
  // Three times the noise: a ninth of the weight.
  std::vector<RecordSegment> noisier = recorded.segments;
  for (RecordSegment& s : noisier) s.variance *= 9;
  const Fitter fitter(recorded.plant, noisier, {});
  const std::vector<NeededSignal> of_noisier =
      needed_signals(fitter, recorded.freed(test::in_frame(kFrame)));
  for (std::size_t r = 0; r < needed.size(); ++r)
    EXPECT_LT((9 * of_noisier[r].weight - needed[r].weight).norm(), 1e-9 * needed[r].weight.norm());
}

TEST(NeededSignal, DeformationIsRelativeToTheGround) {
  constexpr double kOff = 0.02;
  const Recorded recorded(test::records_with({}));
  const Localisation place = recorded.freed(test::in_frame(kFrame));
  const NeededSignal needed = needed_signals(recorded.fitter, place).front();
  const RecordSegment& s = recorded.segments.front();
  // Frame 2 is the first y-parallel one: its axis over base y.
  const VectorXcd drift = (s.spectrum.row(kFrame) - s.spectrum.row(5)).transpose();
  const VectorXcd wanted = -drift.array() / s.w.array().square();
  EXPECT_LT((needed.d - wanted).norm(), kOff * wanted.norm());
  const int ratio = recorded.fitter.ratio(0);
  ASSERT_EQ(needed.d_t.size(), s.intervals() * ratio);
  // The rate is the deformation's slope.
  const double step_s = 1 / (s.rate_hz * ratio);
  const VectorXd slope =
      (needed.d_t.tail(needed.d_t.size() - 2) - needed.d_t.head(needed.d_t.size() - 2)) /
      (2 * step_s);
  const VectorXd rate = needed.v_t.segment(1, slope.size());
  EXPECT_LT((slope - rate).norm(), kOff * rate.norm());
}

TEST(NeededSignal, RecoversAnExternalForceWithSignAndSize) {
  constexpr double kForce_n = 3000, kHz = 3.3, kPhase = 0.4;
  const Recorded recorded(
      test::records_with({test::effect_of(EffectKind::unmeasured_force, test::at_node(kFrame),
                                          {kForce_n, kHz, kPhase, 0, 0.1, 10, 1, 0})}));
  const NeededSignal needed =
      needed_signals(recorded.fitter, recorded.freed(test::in_frame(kFrame))).front();
  const RecordSegment& s = recorded.segments.front();
  VectorXd force(s.intervals());
  for (Eigen::Index i = 0; i < force.size(); ++i)
    force[i] = kForce_n * std::sin(2 * M_PI * kHz * static_cast<double>(i) / s.rate_hz + kPhase);
  const VectorXcd outside = band_of(force, s, 1);
  std::vector<VectorXcd> columns = linear_columns(needed, s.w);
  columns.push_back(outside);
  const VectorXd found = scalar_fit({needed}, {columns}).coefficients;
  // A restoring force counts positive, an external force negative.
  EXPECT_NEAR(found[2], -1, kForceOff);
  EXPECT_LT(left_of(needed, s.w, {outside}), kForceOff);
}

TEST(NeededSignal, RecoversTheForceOfALawWithSignAndSize) {
  constexpr double kStiffness_npm3 = 2e10;
  const Recorded recorded(test::records_with(
      {test::effect_of(EffectKind::cubic_stiffness, test::in_frame(kFrame), {kStiffness_npm3})}));
  const NeededSignal needed =
      needed_signals(recorded.fitter, recorded.freed(test::in_frame(kFrame))).front();
  const RecordSegment& s = recorded.segments.front();
  const VectorXcd cube = band_of(needed.d_t.array().cube().matrix(), s, recorded.fitter.ratio(0));
  std::vector<VectorXcd> columns = linear_columns(needed, s.w);
  columns.push_back(cube);
  const VectorXd found = scalar_fit({needed}, {columns}).coefficients;
  EXPECT_NEAR(found[2] / kStiffness_npm3, 1, kForceOff);
}

TEST(NeededSignal, LeavesOutForcesOfOtherPlaces) {
  // Both frames of a direction need a force. With the other frame free, each needs only its own
  // force.
  constexpr double kForce_n = 4000;
  const auto force = [&](int frame, double hz) {
    return test::effect_of(EffectKind::unmeasured_force, test::at_node(frame),
                           {kForce_n, hz, 0, 0, 0.1, 10, 1, 0});
  };
  constexpr double kHz = 3.1, kOtherHz = 4.3;
  const Recorded recorded(test::records_with({force(kFrame, kHz), force(kOther, kOtherHz)}));
  const Model model = recorded.linear().model;
  std::vector<CandidatePlace> both;
  for (const int frame : {kFrame, kOther})
    for (const CandidatePlace& c : candidate_places_of(recorded.plant, model))
      if (c.place == test::in_frame(frame)) both.push_back(c);
  const Localisation pair = localise(recorded.fitter, model, {}, both, 6);
  const NeededSignal needed = needed_signals(recorded.fitter, pair).front();
  const RecordSegment& s = recorded.segments.front();
  const auto power_at = [&](double hz) {
    double out = 0;
    for (Eigen::Index b = 0; b < s.bins(); ++b)
      if (std::abs(s.w[b] / (2 * M_PI) - hz) < 0.1) out += std::norm(needed.force[b]);
    return out;
  };
  EXPECT_GT(power_at(kHz), 20 * power_at(kOtherHz));
}

using Eigen::Index;

constexpr Index kBins = 30;
constexpr double kRounding = 1e-8;  // the fit regularizes by 1e-10

VectorXcd any_signal(Random& random) {
  VectorXcd out(kBins);
  for (Index b = 0; b < kBins; ++b) out[b] = {random.normal(), random.normal()};
  return out;
}

/// A record's needed force and columns that may explain it.
struct AnyRecord {
  NeededSignal needed;
  std::vector<VectorXcd> columns;

  AnyRecord(Random& random, std::size_t count) {
    needed.force = any_signal(random);
    needed.weight.resize(kBins);
    for (double& weight : needed.weight) weight = 0.5 + random.uniform();
    for (std::size_t c = 0; c < count; ++c) columns.push_back(any_signal(random));
  }

  /// Returns real and imaginary rows, each times the square root of its weight.
  VectorXd rows(const VectorXcd& signal) const {
    VectorXd out(2 * kBins);
    out << signal.real().cwiseProduct(needed.weight.cwiseSqrt()),
        signal.imag().cwiseProduct(needed.weight.cwiseSqrt());
    return out;
  }
};

TEST(ScalarFit, IsTheWeightedLeastSquaresOfAllRecords) {
  constexpr std::size_t kColumns = 3;
  Random random(5);
  const AnyRecord one(random, kColumns), two(random, kColumns);
  Eigen::MatrixXd x(4 * kBins, static_cast<Index>(kColumns));
  for (std::size_t c = 0; c < kColumns; ++c)
    x.col(static_cast<Index>(c)) << one.rows(one.columns[c]), two.rows(two.columns[c]);
  VectorXd y(4 * kBins);
  y << one.rows(one.needed.force), two.rows(two.needed.force);
  const VectorXd wanted = (x.transpose() * x).llt().solve(x.transpose() * y);
  const ScalarFit fit = scalar_fit({one.needed, two.needed}, {one.columns, two.columns});
  EXPECT_LT((fit.coefficients - wanted).norm(), kRounding);
  EXPECT_NEAR(fit.misfit, (y - x * wanted).squaredNorm(), kRounding * y.squaredNorm());
}

TEST(ScalarFit, CoefficientsAreReal) {
  // A column with its phase turned by a quarter explains none of the force.
  Random random(6);
  AnyRecord record(random, 0);
  const VectorXcd quarter = Complex(0, 1) * record.needed.force;
  const ScalarFit fit = scalar_fit({record.needed}, {{quarter}});
  EXPECT_NEAR(fit.coefficients[0], 0, kRounding);
  EXPECT_NEAR(fit.misfit, scalar_sums(record.needed, {}).total, kRounding);
}

TEST(ScalarFit, HandlesColumnsOfVerySmallUnits) {
  constexpr double kLarge = 3e8, kSmall = 2e-7;
  Random random(7);
  AnyRecord record(random, 2);
  record.columns[0] *= 1 / kLarge;
  record.columns[1] *= 1 / kSmall;
  record.needed.force = kLarge * record.columns[0] - 4 * kSmall * record.columns[1];
  const ScalarFit fit = scalar_fit({record.needed}, {record.columns});
  EXPECT_NEAR(fit.coefficients[0] / kLarge, 1, kRounding);
  EXPECT_NEAR(fit.coefficients[1] / kSmall, -4, kRounding);
}

TEST(ScalarFit, SharesTheForceBetweenEqualColumns) {
  Random random(8);
  AnyRecord record(random, 1);
  record.columns.push_back(record.columns[0]);
  record.columns.push_back(VectorXcd::Zero(kBins));
  record.needed.force = 6 * record.columns[0];
  const ScalarFit fit = scalar_fit({record.needed}, {record.columns});
  ASSERT_TRUE(fit.coefficients.allFinite());
  EXPECT_NEAR(fit.coefficients[0] + fit.coefficients[1], 6, 1e-6);
  EXPECT_NEAR(fit.misfit / scalar_sums(record.needed, {}).total, 0, kRounding);
}

TEST(ScalarFit, SumsOfRecordsAddUp) {
  Random random(9);
  const AnyRecord one(random, 2), two(random, 2);
  const ScalarSums a = scalar_sums(one.needed, one.columns),
                   b = scalar_sums(two.needed, two.columns);
  ScalarSums both = a;
  both += b;
  EXPECT_LT((both.normal - a.normal - b.normal).norm(), kRounding);
  EXPECT_LT((both.right - a.right - b.right).norm(), kRounding);
  EXPECT_DOUBLE_EQ(both.total, a.total + b.total);
  EXPECT_LE(a.fit().misfit + b.fit().misfit, both.fit().misfit + kRounding);
}

TEST(LawParameter, ScalesItsValueAndBounds) {
  const LawParameter linear = linear_parameter(-3, -0.5);
  EXPECT_DOUBLE_EQ(linear.plain(), -3);
  EXPECT_DOUBLE_EQ(linear.step, 0.5);
  EXPECT_GT(linear_parameter(1, 0).step, 0);
  const LawParameter logarithmic = logarithmic_parameter(0.02, 1e-3, 4);
  EXPECT_NEAR(logarithmic.plain(), 0.02, 1e-15);
  EXPECT_NEAR(std::exp(logarithmic.low), 1e-3, 1e-15);
  EXPECT_NEAR(std::exp(logarithmic.high), 4, 1e-12);
  const LawParameter fixed = bounded_parameter(2, 0.1, 1, 3, false);
  EXPECT_FALSE(fixed.free);
  EXPECT_DOUBLE_EQ(fixed.low, 1);
  EXPECT_DOUBLE_EQ(fixed.high, 3);
}

}  // namespace needed_signal_test

}  // namespace framewatch::estimator
