// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/judged_fit.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "estimator/diagnose/fit/gap.h"
#include "estimator/diagnose/model/modal_damping.h"
#include "estimator/diagnose/trials/damping_form.h"
#include "tests/estimator/diagnose/exact_record.h"
#include "tests/estimator/diagnose/other_buildings.h"

namespace framewatch::estimator {
namespace judged_fit_test {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::Small;

constexpr double kWithin = 1.05;  // of the best free run of the class
constexpr Tolerances kExact{0, 0, 0};

/// An independent fit: Newmark's scheme, differences in the band of the record, Levenberg's method
/// over the logarithms of all stiffnesses and dampings.
class Independent {
 public:
  Independent(const Small& small, const RecordSegment& segment) : small_(small), s_(segment) {}

  /// Returns the smallest free-run NRMSE, from a start.
  double least_gap(VectorXd theta) const {
    constexpr int kSteps = 40;
    constexpr double kChange = 1e-4;
    VectorXd rest = difference(theta);
    double damping = 1e-3;
    for (int step = 0; step < kSteps; ++step) {
      MatrixXd jacobian(rest.size(), theta.size());
      for (Index p = 0; p < theta.size(); ++p) {
        VectorXd moved = theta;
        moved[p] *= 1 + kChange;
        jacobian.col(p) = (difference(moved) - rest) / kChange;
      }
      const MatrixXd square = jacobian.transpose() * jacobian;
      bool better = false;
      for (int i = 0; i < 8 && !better; ++i) {
        MatrixXd damped = square;
        damped.diagonal() *= 1 + damping;
        const VectorXd change = -damped.ldlt().solve(jacobian.transpose() * rest);
        const VectorXd trial = theta.array() * change.cwiseMax(-1).cwiseMin(1).array().exp();
        const VectorXd then = difference(trial);
        better = then.squaredNorm() < rest.squaredNorm();
        if (better) {
          theta = trial;
          rest = then;
        }
        damping *= better ? 0.1 : 10;
      }
      if (!better) break;
    }
    return rest.norm() / measured().norm();
  }

 private:
  /// Returns real and imaginary parts of the frames' axes in the band.
  VectorXd in_band(const MatrixXd& signals) const {
    VectorXd out(2 * 4 * s_.bins());
    for (Index a = 0; a < 4; ++a) {
      const Eigen::VectorXcd bins = band_of(signals.col(a), s_, 1);
      out.segment(2 * a * s_.bins(), s_.bins()) = bins.real();
      out.segment((2 * a + 1) * s_.bins(), s_.bins()) = bins.imag();
    }
    return out;
  }
  VectorXd measured() const { return in_band(s_.accel.topRows(s_.intervals())); }

  VectorXd difference(const VectorXd& theta) const {
    constexpr int kSubsteps = 8;
    const Matrices m = assemble(small_.structure, small_.table, theta);
    const double h = 1 / (s_.rate_hz * kSubsteps);
    const MatrixXd mass = m.mass.asDiagonal();
    const Eigen::PartialPivLU<MatrixXd> solver(mass + 0.5 * h * m.damping +
                                               0.25 * h * h * m.stiffness);
    VectorXd x = VectorXd::Zero(4), v = x, a = x;
    MatrixXd out(s_.intervals(), 4);
    for (Index i = 0; i < s_.intervals(); ++i)
      for (int k = 0; k < kSubsteps; ++k) {
        const double part = static_cast<double>(k) / kSubsteps;
        VectorXd ground(4);
        for (Index f = 0; f < 4; ++f) {
          const Index axis = f < 2 ? 4 : 5;
          ground[f] = (1 - part) * s_.accel(i, axis) + part * s_.accel(i + 1, axis);
        }
        const VectorXd to_x = x + h * v + 0.25 * h * h * a, to_v = v + 0.5 * h * a;
        a = solver.solve(-mass * ground - m.damping * to_v - m.stiffness * to_x);
        x = to_x + 0.25 * h * h * a;
        v = to_v + 0.5 * h * a;
        if (k == 0) out.row(i) = (a + ground).transpose();
      }
    return measured() - in_band(out);
  }

  const Small& small_;
  const RecordSegment& s_;
};

struct Case {
  Small small;
  Plant plant = small.plant();
  std::vector<RecordSegment> segments;

  explicit Case(const MatrixXd& record) : segments(small.segments({record})) {}
};

TEST(JudgedFit, HasTheBestFreeRunOfItsClass) {
  constexpr double kFarAboveNoise = 30;
  for (const double k3 : {2e11, 8e11}) {
    const Case c(Small().record({test::cubic_spring(2, k3).simulated}, 1));
    const Fitter fitter(c.plant, c.segments, kExact);
    const FitResult noise = fitter.fit(initial_model(c.plant), {}, {});
    ASSERT_GT(noise.total_misfit(), kFarAboveNoise * fitter.expected(noise.model));
    const JudgedFit judged =
        judged_fit(fitter, linear_starts(c.plant, noise.model), FitOptions{}.max_steps);
    EXPECT_FALSE(judged.near_noise);
    EXPECT_LE(judged.gap, rms_gap(fitter, noise.model));
    EXPECT_DOUBLE_EQ(judged.gap, rms_gap(fitter, judged.model));
    EXPECT_GT(judged.model.theta.minCoeff(), 0) << "physical";
    const Independent other(c.small, c.segments.front());
    const double best = std::min(other.least_gap(c.small.truth), other.least_gap(c.small.design));
    EXPECT_LT(judged.gap, kWithin * best) << k3;
    EXPECT_GT(judged.gap, best / kWithin / kWithin) << "both fit the same gap";
  }
}

/// Modal ratios that dashpots between floors cannot produce. With a strong cubic spring there are
/// none.
TEST(JudgedFit, AllowsDampingThatDashpotsCannotProduce) {
  constexpr double kClearly = 0.97;
  for (const bool of_modes : {true, false}) {
    Small small = test::tower(2);
    std::vector<Effect> effects{test::cubic_spring(2, of_modes ? 1e8 : 2e11).simulated};
    if (of_modes) {
      small.truth.tail(small.table.elements()) *= 0.1;
      for (const int mode : {1, 2, 3, 4}) {
        EffectPlace place;
        place.kind = PlaceKind::mode;
        place.mode = mode;
        effects.push_back(make_effect(EffectKind::modal_damping, place));
        effects.back().set("damping_ratio", mode % 2 == 0 ? 0.002 : 0.04);
      }
    }
    const Plant plant = small.plant();
    const std::vector<RecordSegment> segments = small.segments({small.record(effects, 1)});
    const Fitter fitter(plant, segments, kExact);
    Model model = initial_model(plant);
    const auto gap_of = [&](const Model& start) {
      return judged_fit(fitter, linear_starts(plant, start), FitOptions{}.max_steps);
    };
    const JudgedFit dashpots = gap_of(model);
    add_modal_damping(plant, model);
    const JudgedFit ratios = gap_of(model);
    EXPECT_EQ(has_modal_damping(ratios.model), of_modes);
    if (of_modes)
      EXPECT_LT(ratios.gap, kClearly * dashpots.gap);
    else
      EXPECT_EQ(ratios.gap, dashpots.gap);
  }
}

TEST(JudgedFit, IsTheLikeliestModelNearTheNoise) {
  const Case c(Small().record({}, 1));
  const Fitter fitter(c.plant, c.segments, kExact);
  const JudgedFit judged = judged_fit(fitter, {initial_model(c.plant)}, FitOptions{}.max_steps);
  EXPECT_TRUE(judged.near_noise);
  EXPECT_EQ(
      judged.model.theta,
      fitter.fit(initial_model(c.plant), {}, thorough({}, FitOptions{}.max_steps)).model.theta);
  EXPECT_LT(judged.gap, 1.2 * gaps_of(fitter, judged.model).front().overall_floor);
}

TEST(ModelError, IsRelativeToTheMotionOfTheOutputs) {
  constexpr double kShare = 0.3, kSmall = 1e-9;
  const Case c(Small().record({}, 1));
  const RecordSegment &before = c.segments.front(),
                      after = with_model_error(c.plant, c.segments, kShare).front();
  const double added = after.variance[0] - before.variance[0];
  double noise = 0;
  for (Index a = 0; a < 4; ++a) {
    EXPECT_NEAR(after.variance[a] - before.variance[a], added, kSmall * added);
    noise += added * static_cast<double>(before.bins() * before.intervals());
  }
  EXPECT_EQ(after.variance.tail(2), before.variance.tail(2)) << "the base is no output";
  EXPECT_NEAR(std::sqrt(noise / before.spectrum.topRows(4).squaredNorm()), kShare, kSmall);
}

TEST(GapsOf, ADivergingModelHasNoGap) {
  const Case c(Small().record({}, 1));
  const Fitter fitter(c.plant, c.segments, kExact);
  Model model = test::true_model(c.small, c.plant);
  EXPECT_TRUE(std::isfinite(rms_gap(fitter, model)));
  model.theta[0] = std::nan("");
  EXPECT_TRUE(std::isinf(rms_gap(fitter, model)));
}

}  // namespace judged_fit_test
}  // namespace framewatch::estimator
