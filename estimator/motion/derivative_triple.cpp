#include "estimator/motion/derivative_triple.h"

#include <cmath>

#include <Eigen/Dense>

namespace framewatch {
namespace {

constexpr int kHalfLength = 6;
constexpr int kGridPoints = 500;

/// Weighted least squares with equality constraints: minimise |X c - y|, subject to E c = f.
Eigen::VectorXd constrained_fit(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                                const Eigen::MatrixXd& e, const Eigen::VectorXd& f) {
  const Eigen::Index unknowns = x.cols();
  const Eigen::Index constraints = e.rows();
  Eigen::MatrixXd kkt = Eigen::MatrixXd::Zero(unknowns + constraints, unknowns + constraints);
  kkt.topLeftCorner(unknowns, unknowns) = x.transpose() * x;
  kkt.topRightCorner(unknowns, constraints) = e.transpose();
  kkt.bottomLeftCorner(constraints, unknowns) = e;
  Eigen::VectorXd right(unknowns + constraints);
  right << x.transpose() * y, f;
  return kkt.fullPivLu().solve(right).head(unknowns);
}

/// c_1..c_L of 2 sum c_k sin(k w) = w, relative error, slope exact at w = 0.
Eigen::VectorXd first_derivative() {
  Eigen::MatrixXd x(kGridPoints, kHalfLength);
  Eigen::MatrixXd slope(1, kHalfLength);
  for (int i = 0; i < kGridPoints; ++i) {
    const double w = M_PI / 2 * (i + 0.5) / kGridPoints;
    for (int k = 1; k <= kHalfLength; ++k) x(i, k - 1) = 2 * std::sin(k * w) / w;
  }
  for (int k = 1; k <= kHalfLength; ++k) slope(0, k - 1) = 2 * k;
  return constrained_fit(x, Eigen::VectorXd::Ones(kGridPoints), slope, Eigen::VectorXd::Ones(1));
}

/// c_1..c_L of sum c_k (2 cos(k w) - 2) = -w^2, relative error, curvature exact at w = 0.
Eigen::VectorXd second_derivative() {
  Eigen::MatrixXd x(kGridPoints, kHalfLength);
  Eigen::MatrixXd curvature(1, kHalfLength);
  for (int i = 0; i < kGridPoints; ++i) {
    const double w = M_PI / 2 * (i + 0.5) / kGridPoints;
    for (int k = 1; k <= kHalfLength; ++k) x(i, k - 1) = (2 - 2 * std::cos(k * w)) / (w * w);
  }
  for (int k = 1; k <= kHalfLength; ++k) curvature(0, k - 1) = static_cast<double>(k) * k;
  return constrained_fit(x, Eigen::VectorXd::Ones(kGridPoints), curvature,
                         Eigen::VectorXd::Ones(1));
}

/// taps convolved with (1 + z^-1)^2 / 4.
std::vector<double> with_numerator(const std::vector<double>& taps) {
  std::vector<double> out(taps.size() + 2, 0.0);
  for (std::size_t i = 0; i < taps.size(); ++i) {
    out[i] += taps[i] / 4;
    out[i + 1] += taps[i] / 2;
    out[i + 2] += taps[i] / 4;
  }
  return out;
}

}  // namespace

DerivativeTriple matched_triple(double rate_hz) {
  const Eigen::VectorXd c1 = first_derivative();
  const Eigen::VectorXd c2 = second_derivative();
  constexpr std::size_t kLength = 2 * kHalfLength + 1;
  std::vector<double> d0(kLength, 0.0), d1(kLength, 0.0), d2(kLength, 0.0);
  d0[kHalfLength] = 1;
  for (int k = 1; k <= kHalfLength; ++k) {
    const auto newer = static_cast<std::size_t>(kHalfLength - k);
    const auto older = static_cast<std::size_t>(kHalfLength + k);
    d1[newer] = rate_hz * c1[k - 1];
    d1[older] = -d1[newer];
    d2[newer] = d2[older] = rate_hz * rate_hz * c2[k - 1];
    d2[kHalfLength] -= 2 * d2[newer];
  }
  return {with_numerator(d0), with_numerator(d1), with_numerator(d2), kHalfLength + 1.0};
}

DerivativeTriple trapezoid_triple(double rate_hz) {
  return {{0.25, 0.5, 0.25},
          {rate_hz / 2, 0, -rate_hz / 2},
          {rate_hz * rate_hz, -2 * rate_hz * rate_hz, rate_hz * rate_hz},
          1.0};
}

}  // namespace framewatch
