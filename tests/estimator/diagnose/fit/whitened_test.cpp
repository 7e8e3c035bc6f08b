// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/whitened.h"

#include <cmath>
#include <complex>
#include <limits>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/law_tracks.h"
#include "estimator/diagnose/fit/measured_deformation.h"
#include "estimator/diagnose/fit/normal_equations.h"
#include "estimator/numeric/complex.h"
#include "estimator/simulate/random.h"
#include "tests/estimator/diagnose/exact_record.h"

namespace framewatch::estimator {
namespace whitened_test {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using test::effect_of;
using test::Small;

constexpr double kRounding = 1e-10;
constexpr int kRatio = 2;

struct Case {
  Small small;
  Plant plant = small.plant();
  Model model = test::true_model(small, plant);
  RecordSegment segment = small.segments({small.record({}, 1)}).front();

  Whitened whitened(const Model& m) const {
    return whiten(plant, m, segment, 0, Forcing::measured, {}, kRatio);
  }
  Whitened whitened() const { return whitened(model); }
};

TEST(Whitened, LeavesNoiseOfUnitVarianceForTheTrueModel) {
  constexpr double kSigmas = 4;
  const Case c;
  const Whitened w = c.whitened();
  ASSERT_TRUE(w.good);
  const Index n = c.plant.equations();
  const double left = static_cast<double>(n * w.bins() - 2 * n);
  EXPECT_NEAR(w.misfit, left, kSigmas * std::sqrt(left));
  EXPECT_DOUBLE_EQ(w.misfit, w.rest.squaredNorm());
  // Equal in every equation, in real and imaginary parts: no row has more than its share.
  for (Index row = 0; row < 2 * n; ++row) {
    double power = 0;
    for (Index b = 0; b < w.bins(); ++b) power += std::pow(w.rest[2 * n * b + row], 2);
    const double expected = left / static_cast<double>(2 * n);
    EXPECT_NEAR(power, expected, kSigmas * std::sqrt(expected)) << row;
  }
}

TEST(Whitened, LeavesMoreForAWrongModel) {
  const Case c;
  const double least = c.whitened().misfit;
  Model wrong = c.model;
  wrong.theta[0] *= 1.02;
  EXPECT_GT(c.whitened(wrong).misfit, 1.5 * least);
  wrong = c.model;
  wrong.gain[1] = 0.05;
  EXPECT_GT(c.whitened(wrong).misfit, 1.5 * least);
}

TEST(Whitened, OperationMatchesTheEquations) {
  constexpr double kMassChange = 0.03;
  Case c;
  c.model.mass_change[2] = kMassChange;
  const Whitened w = c.whitened();
  const Index elements = c.plant.element_count();
  VectorXd masses = VectorXd::Ones(4);
  masses[2] += kMassChange;
  for (const Index b : {Index{0}, w.bins() / 2, w.bins() - 1}) {
    MatrixXcd expected = (masses.asDiagonal() * c.plant.building.mass).cast<Complex>();
    for (Index e = 0; e < elements; ++e)
      expected += (-c.model.theta[e] / std::pow(c.segment.w[b], 2) +
                   c.model.theta[e + elements] / (kJ * c.segment.w[b])) *
                  MatrixXd(c.plant.building.act.col(e) * c.plant.building.sense.row(e));
    const MatrixXcd& d = w.operation[static_cast<std::size_t>(b)];
    EXPECT_LT((d - expected).norm(), kRounding * expected.norm());
    // Rows are whitened in the order of the operation on the spectrum.
    const VectorXcd row = w.weights->whitener(b).whole() * d * w.calibrated.col(b);
    EXPECT_LT((w.residual.segment(8 * b, 4) - row.real()).norm(), kRounding * (1 + row.norm()));
    EXPECT_LT((w.residual.segment(8 * b + 4, 4) - row.imag()).norm(), kRounding * (1 + row.norm()));
  }
}

/// Docs/equations.md (34): the shown motion leaves only end terms.
TEST(Whitened, ShownMotionFollowsTheEquations) {
  constexpr double kLeft = 1e-6, kNearer = 0.8;
  const Case c;
  const Whitened w = c.whitened();
  MatrixXcd forces(4, w.bins());
  for (Index b = 0; b < w.bins(); ++b)
    forces.col(b) = w.operation[static_cast<std::size_t>(b)] * w.motion.col(b);
  EXPECT_LT(w.weights->without_ends(whiten_rows(w, forces)).norm(), kLeft * w.rest.norm());
  // It is nearer to the readings of perfect sensors.
  const MatrixXcd exact = c.small.segments({test::exact_record(c.small, {}, 1)}).front().spectrum;
  EXPECT_LT((w.motion - exact).norm(), kNearer * (w.calibrated - exact).norm());
}

TEST(Whitened, CalibrationRemovesErrors) {
  constexpr double kGain = 0.07, kLate_s = 3e-3, kAngle = 0.1;
  Case c;
  const MatrixXcd straight = c.segment.spectrum;
  MatrixXcd& read = c.segment.spectrum;
  EXPECT_EQ(calibrated(c.model, c.segment), straight);
  for (Index b = 0; b < c.segment.bins(); ++b)
    read(1, b) *= std::polar(1 + kGain, -kLate_s * c.segment.w[b]);
  c.model.gain[1] = kGain;
  c.model.clock_s[1] = kLate_s;
  EXPECT_LT((calibrated(c.model, c.segment) - straight).norm(), kRounding * straight.norm());
  read.row(0).swap(read.row(3));
  c.model.effects = {effect_of(LawForm::swapped, test::channel_place(0, 3), {})};
  EXPECT_LT((calibrated(c.model, c.segment) - straight).norm(), kRounding * straight.norm());
  read = straight;
  c.model = test::true_model(c.small, c.plant);
  read.row(2) = std::cos(kAngle) * straight.row(2) + std::sin(kAngle) * straight.row(0);
  c.model.effects = {effect_of(LawForm::misaligned, test::channel_place(2, 0), {kAngle})};
  EXPECT_LT((calibrated(c.model, c.segment) - straight).norm(), kRounding * straight.norm());
}

TEST(Whitened, NoiseOfABinMatchesTheMotion) {
  constexpr double kGain = 0.25;
  constexpr Index kBin = 5;
  Case c;
  c.segment.variance = VectorXd::LinSpaced(6, 1e-4, 6e-4);
  const VectorXd white = static_cast<double>(c.segment.intervals()) * c.segment.variance;
  EXPECT_LT((bin_noise(c.model, c.segment, kBin) - white).norm(), kRounding);
  c.model.gain[3] = kGain;
  c.segment.displaced = {false, true};
  c.model.effects = {effect_of(LawForm::swapped, test::channel_place(0, 4), {})};
  VectorXd expected = white;
  expected[3] /= (1 + kGain) * (1 + kGain);
  expected[1] *= std::pow(c.segment.w[kBin], 4);
  std::swap(expected[0], expected[4]);
  EXPECT_LT((bin_noise(c.model, c.segment, kBin) - expected).norm(), kRounding * expected.norm());
}

TEST(Whitened, RowsOfForcesAndOfReadingsAgree) {
  const Case c;
  const Whitened w = c.whitened();
  const VectorXd direction = Eigen::Vector4d(1, -2, 0.5, 0);
  const VectorXcd signal = w.calibrated.row(2).transpose();
  MatrixXcd forces(4, w.bins()), readings(4, w.bins());
  for (Index b = 0; b < w.bins(); ++b) {
    forces.col(b) = direction * signal[b];
    readings.col(b) = w.operation[static_cast<std::size_t>(b)].col(3) * signal[b];
  }
  const VectorXd of_forces = whiten_rows(w, forces), of_readings = whiten_rows(w, readings);
  EXPECT_LT((whiten_rows(w, direction, signal) - of_forces).norm(), kRounding * of_forces.norm());
  EXPECT_LT((whiten_axis(w, 3, signal) - of_readings).norm(), kRounding * of_readings.norm());
}

TEST(Whitened, IgnoresFreeForcesAndReadings) {
  constexpr double kChance = 5;  // deviations of the misfit
  const Case c;
  const double chance = kChance * std::sqrt(c.whitened().misfit);
  struct Free {
    ModelEffect effect;
    int axis;  // with a wrong reading
  };
  for (const Free& f : {Free{effect_of(LawForm::clipped, test::channel_place(1), {}), 1},
                        Free{effect_of(LawForm::clipped, test::channel_place(4), {}), 4}}) {
    Case garbled;
    garbled.segment.spectrum.row(f.axis) *= 1.3;
    EXPECT_GT(garbled.whitened().misfit, c.whitened().misfit + 3 * chance);
    const Model free = test::with_effects(c.model, {f.effect});
    EXPECT_LT(garbled.whitened(free).misfit, c.whitened().misfit + chance) << f.axis;
  }
  Case pushed;
  const auto node = test::node_place(2);
  Effect force = make_effect(EffectKind::unmeasured_force, node);
  force.set("amplitude_n", 4000);
  force.set("frequency_hz", 3.1);
  force.set("rms_n", 0);
  pushed.segment = pushed.small.segments({pushed.small.record({force}, 1)}).front();
  EXPECT_GT(pushed.whitened().misfit, c.whitened().misfit + 3 * chance);
  const Model broadband = test::with_effects(c.model, {effect_of(LawForm::broadband, node, {})});
  EXPECT_LT(pushed.whitened(broadband).misfit, c.whitened().misfit + chance);
}

TEST(Whitened, IsNotGoodIfItCannotBeComputed) {
  const Case c;
  Model unknown = c.model;
  unknown.theta[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(c.whitened(unknown).good);
  Model away = test::with_effects(
      c.model, {effect_of(LawForm::power, test::frame_place(2), {-5 * c.small.truth[0], 1})});
  EXPECT_FALSE(whiten(c.plant, away, c.segment, 0, Forcing::simulated, {}, kRatio).good);
  away.effects[0].parameters[0].value = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(c.whitened(away).good);
}

constexpr double kProductRounding = 1e-12;
constexpr Index kEquations = 4, kAxes = 6;

/// Products of all bins at once equal those of each bin's operation, stored or computed on demand.
TEST(Operations, MultiplyAllBinsAtOnce) {
  const test::Small small;
  const Plant plant = small.plant();
  const Model model = test::true_model(small, plant);
  ASSERT_EQ(plant.equations(), kEquations);
  ASSERT_EQ(plant.axis_count(), kAxes);
  Random random(3);
  const auto some = [&](Index rows, Index columns) {
    return MatrixXd(MatrixXd::NullaryExpr(rows, columns, [&] { return random.normal(); }));
  };
  const MatrixXd mass = some(kEquations, kAxes), stiffness = 50 * some(kEquations, kAxes),
                 damping = some(kEquations, kAxes);
  const EffectPlace node = test::node_place(2);
  const LinearOperation resonator(plant, model,
                                  effect_of(LawForm::resonator, node, {2, 1.5, 0.05}));
  const LinearOperation damper(plant, model, effect_of(LawForm::damper, node, {30}));
  for (const Index bins : {Index{7}, Index{50000}}) {
    const Eigen::VectorXd w = Eigen::VectorXd::LinSpaced(bins, 3, 40);
    const Operations operations(mass, stiffness, damping, {resonator, damper}, w);
    MatrixXcd motion(kAxes, bins), forces(kEquations, bins);
    motion.real() = some(kAxes, bins);
    motion.imag() = some(kAxes, bins);
    forces.real() = some(kEquations, bins);
    forces.imag() = some(kEquations, bins);
    const MatrixXcd times = operations.times(motion), back = operations.adjoint_times(forces),
                    axis = operations.of_axis(3);
    for (const Index b : {Index{0}, bins / 2, bins - 1}) {
      const MatrixXcd d = operations[static_cast<std::size_t>(b)];
      EXPECT_LT((times.col(b) - d * motion.col(b)).norm(), kProductRounding * d.norm());
      EXPECT_LT((back.col(b) - d.adjoint() * forces.col(b)).norm(), kProductRounding * d.norm());
      EXPECT_LT((axis.col(b) - d.col(3)).norm(), kProductRounding * d.norm());
    }
  }
  const Operations plain(mass, stiffness, damping, {}, Eigen::VectorXd::LinSpaced(50000, 3, 40));
  EXPECT_LT((plain.of_axis(2).col(9) - plain[9].col(2)).norm(), kProductRounding * plain[9].norm());
}

}  // namespace whitened_test

}  // namespace framewatch::estimator
