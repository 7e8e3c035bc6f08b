// SPDX-License-Identifier: MIT
#include "estimator/modes/natural_modes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "daemon/tools/lab/accuracy_trial.h"
#include "daemon/tools/lab/study_buildings.h"
#include "estimator/modes/mode_shapes.h"
#include "estimator/refine/max_likelihood.h"
#include "estimator/structure/matrices.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace natural_modes_test {

constexpr double kRounding = 1e-9;        // relative
constexpr double kFrequencyError = 5e-4;  // relative, at 1 % noise
constexpr double kRatioError = 5e-3;      // relative, or
constexpr double kOfCritical = 2e-4;      // absolute
constexpr double kLeastMac = 0.9999;
constexpr double kLeastCoverage = 0.90, kMostCoverage = 0.99;

using Complex = std::complex<double>;

/// Returns the eigenvalues above the real axis from the whole state matrix, without undamped modes.
std::vector<Complex> eigenvalues(const Structure& s, const Eigen::VectorXd& theta) {
  const Matrices m = assemble(s, ParameterTable(s), theta);
  const Eigen::Index n = m.mass.size();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  a.topRightCorner(n, n).setIdentity();
  a.bottomLeftCorner(n, n) = -(m.mass.cwiseInverse().asDiagonal() * m.stiffness);
  a.bottomRightCorner(n, n) = -(m.mass.cwiseInverse().asDiagonal() * m.damping);
  std::vector<Complex> out;
  const Eigen::VectorXcd values = Eigen::EigenSolver<Eigen::MatrixXd>(a, false).eigenvalues();
  for (const Complex& value : values)
    if (value.imag() > 0) out.push_back(value);
  std::sort(out.begin(), out.end(), [](const Complex& one, const Complex& other) {
    return std::abs(one) < std::abs(other);
  });
  return out;
}

NaturalModes modes_of(const Structure& s, const Eigen::VectorXd& theta,
                      const Eigen::MatrixXd& covariance = {}, int most = 24) {
  return natural_modes(s, ParameterTable(s), {theta, {}}, theta, covariance, most);
}

TEST(NaturalModes, AreTheEigenvaluesOfTheStateMatrix) {
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const daemon::RandomBuilding b = daemon::random_building(seed);  // damping not proportional
    const std::vector<Complex> expected = eigenvalues(b.structure, b.truth);
    const NaturalModes found = modes_of(b.structure, b.truth, {}, 1000);
    ASSERT_EQ(found.modes.size(), expected.size());
    EXPECT_EQ(found.overdamped, 0);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double radius = std::abs(expected[i]);
      EXPECT_NEAR(found.modes[i].frequency_hz, radius / (2 * M_PI), kRounding * radius);
      EXPECT_NEAR(found.modes[i].damping_ratio, -expected[i].real() / radius, kRounding);
      EXPECT_TRUE(std::isnan(found.modes[i].frequency_error_hz));
    }
  }
}

TEST(NaturalModes, ShapesSolveTheEquationOfMotion) {
  const daemon::RandomBuilding b = daemon::random_building(2);
  const Matrices m = assemble(b.structure, ParameterTable(b.structure), b.truth);
  for (const NaturalMode& mode : modes_of(b.structure, b.truth).modes) {
    const double w = 2 * M_PI * mode.frequency_hz, h = mode.damping_ratio;
    const Complex lambda = w * Complex(-h, std::sqrt(1 - h * h));
    const Eigen::VectorXcd left =
        lambda * lambda * m.mass.cast<Complex>().cwiseProduct(mode.shape) +
        lambda * (m.damping * mode.shape) + m.stiffness * mode.shape;
    EXPECT_LT(left.norm(), 1e-6 * (m.stiffness * mode.shape).norm());
    EXPECT_NEAR(mode.shape.cwiseAbs().maxCoeff(), 1, kRounding);
    EXPECT_NEAR(mode.motion[0] + mode.motion[1] + mode.motion[2], 1, kRounding);
  }
}

TEST(NaturalModes, ErrorsAreTheSlopesOfFiniteDifferences) {
  // GIVEN a covariance of one parameter only: a standard error is the slope times its error
  constexpr double kStep = 1e-5, kAgree = 1e-4;
  const daemon::RandomBuilding b = daemon::random_building(3);
  const auto size = b.truth.size();
  for (const Eigen::Index p : {Eigen::Index{0}, size / 2 - 1, size / 2, size - 1}) {
    const double error = kStep * b.truth[p];
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(size, size);
    covariance(p, p) = error * error;
    Eigen::VectorXd above = b.truth, below = b.truth;
    above[p] += error;
    below[p] -= error;
    const auto found = modes_of(b.structure, b.truth, covariance).modes;
    const auto high = modes_of(b.structure, above).modes, low = modes_of(b.structure, below).modes;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (found[i].first_equal != found[i].last_equal) continue;
      const double hz = (high[i].frequency_hz - low[i].frequency_hz) / 2;
      const double ratio = (high[i].damping_ratio - low[i].damping_ratio) / 2;
      EXPECT_NEAR(found[i].frequency_error_hz, std::abs(hz),
                  kAgree * kStep * found[i].frequency_hz);
      EXPECT_NEAR(found[i].damping_error, std::abs(ratio), kAgree * kStep);
      const Eigen::VectorXd shape = (high[i].shape - low[i].shape).real() / 2;
      EXPECT_LT((found[i].shape_error - shape.cwiseAbs()).cwiseAbs().maxCoeff(),
                kAgree * kStep + 1e-3 * shape.cwiseAbs().maxCoeff())
          << "parameter " << p << ", mode " << i;
    }
  }
}

TEST(NaturalModes, AtOnePercentNoiseAreWithinTheirErrors) {
  // GIVEN the paper's building in 12 motions of 60 s, 1 % noise on every accelerometer
  constexpr int kMotions = 12;
  constexpr double kRecord_s = 60;
  constexpr double kRate_hz = 100;
  // In mode 3 all floors shear and hardly anything else moves, so the frames' sensors show it
  // least: its standard error in 40 s is 0.05 % of the frequency.
  constexpr std::size_t kShearing = 3;
  constexpr double kOfShearing = 4;
  const Structure s = test::table1();
  const Eigen::VectorXd truth = test::table1_theta();
  const std::vector<Complex> expected = eigenvalues(s, truth);
  const auto exact = modes_of(s, truth).modes;
  int covered = 0, intervals = 0;
  for (int motion = 1; motion <= kMotions; ++motion) {
    const auto seed = static_cast<std::uint64_t>(motion);
    KanaiTajimi ground;
    ground.duration_s = kRecord_s;
    ground.strong_s = kRecord_s - 10;
    ground.seed = seed;
    const daemon::ExactRecord segment =
        daemon::exact_record(s, truth, directed(kanai_tajimi(ground), M_PI / 4), 0.01, kRecord_s);
    const Eigen::VectorXd design =
        daemon::perturbed_design(ParameterTable(s), truth, 0.1, 0.3, seed);
    // WHEN the modes of the refined model are computed
    const Refinement r = refine_max_likelihood(
        s, segment.axes, kRate_hz, daemon::with_noise(segment, 31 * seed), design, design);
    ASSERT_EQ(r.status, RefineStatus::converged);
    const NaturalModes found =
        natural_modes(s, ParameterTable(s), {design, {}}, r.theta, r.covariance);
    ASSERT_EQ(found.modes.size(), expected.size());
    // THEN they reach the limits, and 95 % intervals hold the truth as often as they say
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const NaturalMode& mode = found.modes[i];
      const double hz = std::abs(expected[i]) / (2 * M_PI);
      const double ratio = -expected[i].real() / std::abs(expected[i]);
      const double limit = i == kShearing ? kOfShearing : 1;
      EXPECT_NEAR(mode.frequency_hz, hz, limit * kFrequencyError * hz) << i;
      EXPECT_NEAR(mode.damping_ratio, ratio, limit * std::max(kOfCritical, kRatioError * ratio))
          << i;
      EXPECT_GT(mac(mode.shape, exact[i].shape), kLeastMac) << i;
      covered += std::abs(mode.frequency_hz - hz) < 1.96 * mode.frequency_error_hz ? 1 : 0;
      covered += std::abs(mode.damping_ratio - ratio) < 1.96 * mode.damping_error ? 1 : 0;
      intervals += 2;
      for (Eigen::Index d = 0; d < mode.shape.size(); ++d) {
        if (!(mode.shape_error[d] > 0)) continue;  // the entry that is 1
        covered +=
            std::abs(mode.shape[d].real() - exact[i].shape[d].real()) < 1.96 * mode.shape_error[d]
                ? 1
                : 0;
        ++intervals;
      }
    }
  }
  const double coverage = static_cast<double>(covered) / intervals;
  RecordProperty("coverage", std::to_string(coverage));
  EXPECT_GT(coverage, kLeastCoverage);
  EXPECT_LT(coverage, kMostCoverage);
}

/// Two stories of 1x1 bay, square in plan, with alike frames.
Structure square() {
  Structure s = test::table1();
  s.stories = 2;
  s.story_height.resize(2);
  s.span_y = s.span_x;
  s.node_mass.assign(static_cast<std::size_t>(s.nodes()), 1e4);
  return s;
}

Eigen::VectorXd alike_frames(const Structure& s) {
  const ParameterTable table(s);
  Eigen::VectorXd theta = Eigen::VectorXd::Constant(table.size(), 3e6);
  theta.tail(table.elements()) *= 1e-3;
  return theta;
}

TEST(NaturalModes, OfASquarePlanAreEqualAndCleanlyAlongXAndYAndInRotation) {
  // With its mass at four corners, a square plan turns as fast as it moves along x and along y.
  const Structure s = square();
  const auto modes = modes_of(s, alike_frames(s)).modes;
  ASSERT_EQ(modes.size(), 8u);
  std::array<double, 3> sum{};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(modes[i].frequency_hz, modes[0].frequency_hz, 1e-9);
    EXPECT_EQ(modes[i].first_equal, 0);
    EXPECT_EQ(modes[i].last_equal, 2);
    EXPECT_GT(*std::max_element(modes[i].motion.begin(), modes[i].motion.end()), 1 - 1e-9);
    for (std::size_t of = 0; of < 3; ++of) sum[of] += modes[i].motion[of];
  }
  for (const double one : sum) EXPECT_NEAR(one, 1, 1e-9);
}

TEST(NaturalModes, EqualWithinTheirErrorsHaveNoShapeErrors) {
  // GIVEN frames along y that are 0.1 % stiffer than those along x, known to 1 %
  const Structure s = square();
  const ParameterTable table(s);
  Eigen::VectorXd theta = alike_frames(s);
  for (int p = 0; p < table.size(); ++p)
    if (table[p].kind == ParameterKind::frame_stiffness && table[p].direction == Direction::y)
      theta[p] *= 1.001;
  const Eigen::MatrixXd covariance = (1e-4 * theta.cwiseAbs2()).asDiagonal();
  const auto modes = modes_of(s, theta, covariance).modes;
  EXPECT_EQ(modes[0].last_equal, 2);
  EXPECT_TRUE(modes[0].shape_error.array().isNaN().all());
  EXPECT_GT(modes[0].frequency_error_hz, 0);
  // THEN the slower mode is the one along x, and their subspace holds any mixture
  EXPECT_GT(modes[0].motion[0], 1 - 1e-9);
  const Eigen::VectorXcd mixture = 0.6 * modes[0].shape + 0.8 * modes[1].shape;
  std::vector<ComparedMode> equal;
  for (std::size_t i = 0; i < 3; ++i)
    equal.push_back({modes[i].frequency_hz, modes[i].shape, 0, 2});
  EXPECT_NEAR(mac({{modes[0].frequency_hz, mixture}}, 0, equal, 0), 1, 1e-9);
  // ... and with errors of 0.001 % the modes are apart
  const auto apart = modes_of(s, theta, 1e-6 * covariance).modes;
  EXPECT_EQ(apart[0].last_equal, 0);
  EXPECT_TRUE(apart[0].shape_error.allFinite());
}

TEST(NaturalModes, OverdampedPairsHaveNoFrequency) {
  Structure s;
  s.stories = 1;
  s.frames_x = {"a"};
  s.story_height = {3};
  s.node_mass = {1};
  const NaturalModes found = modes_of(s, Eigen::Vector2d(100, 25));
  EXPECT_TRUE(found.modes.empty());
  EXPECT_EQ(found.overdamped, 1);
}

TEST(NaturalModes, BendingLowersTheFrequenciesAsItsSpringsSay) {
  // GIVEN one story of height h whose frame stands on a rotational spring: k and kr / h^2 in series
  Structure s;
  s.stories = 1;
  s.frames_x = {"a"};
  s.story_height = {2};
  s.node_mass = {5};
  GroupDesign design{Eigen::Vector2d(900, 1), {}};
  design.bending_nmprad.base_nmprad[0] = 1200;
  std::vector<SensorAxis> axes(2);
  axes[1].story = 1;
  axes[1].frame = 0;
  const ParameterTable table(s, story_groups(s, axes, {{}, true}), design.bending_nmprad);
  ASSERT_EQ(table.size(), 3);
  const Eigen::VectorXd theta = group_parameters(s, table, design);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(3, 3);
  covariance(2, 2) = 1;
  const auto modes = natural_modes(s, table, design, theta, covariance).modes;
  ASSERT_EQ(modes.size(), 1u);
  const auto hz = [](double kr) { return std::sqrt(1 / (1 / 900.0 + 4 / kr) / 5) / (2 * M_PI); };
  EXPECT_NEAR(modes[0].frequency_hz, hz(1200), 1e-9);
  EXPECT_NEAR(modes[0].frequency_error_hz, (hz(1201) - hz(1199)) / 2, 1e-8);
}

}  // namespace natural_modes_test
}  // namespace framewatch::estimator
