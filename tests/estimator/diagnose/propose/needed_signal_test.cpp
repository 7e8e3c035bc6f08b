#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/diagnose/propose/needed_signal.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace needed_signal_test {

using Complex = std::complex<double>;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using test::Recorded;

constexpr int kFrame = 2, kOther = 0;
// Of forces that are seen through what is fitted of the frame's stiffness and damping.
constexpr double kForceOff = 0.05;

/// Share of a signal that linear elements and these columns leave, noise apart.
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

TEST(NeededSignal, DeformationIsWhatTheFloorMovesAgainstTheGround) {
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

TEST(NeededSignal, ForceFromOutsideComesBackWithItsSignAndSize) {
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
  // A restoring force is counted, one from outside has the other sign.
  EXPECT_NEAR(found[2], -1, kForceOff);
  EXPECT_LT(left_of(needed, s.w, {outside}), kForceOff);
}

TEST(NeededSignal, ForceOfALawComesBackWithItsSignAndSize) {
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

TEST(NeededSignal, WhatAnotherPlaceDoesIsNotCounted) {
  // Both frames of a direction need something; beside the other, each needs its own alone.
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

}  // namespace needed_signal_test
}  // namespace framewatch::estimator
