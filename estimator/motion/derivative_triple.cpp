// SPDX-License-Identifier: MIT
#include "estimator/motion/derivative_triple.h"

#include <cmath>

#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

constexpr int kHalfLength = 6;
constexpr int kGridPoints = 500;

/// Returns the c that minimizes |x c - y| subject to e c = f, by the null space of e and an
/// orthogonal factorization. Normal equations would lose half the digits.
Eigen::VectorXd constrained_fit(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                                const Eigen::MatrixXd& e, const Eigen::VectorXd& f) {
  const Eigen::MatrixXd q = orthogonal_basis(e.transpose());
  const Eigen::Index constraints = e.rows();
  const Eigen::MatrixXd range = q.leftCols(constraints);
  const Eigen::MatrixXd null = q.rightCols(q.cols() - constraints);
  const Eigen::VectorXd particular = range * solve_lu(e * range, f);
  return particular + null * LeastSquares(x * null).solve(y - x * particular);
}

/// Returns the taps c_-L..c_L, newest first, that fit sum c_k e^(-i w k) = (i w)^order e^(i w
/// advance) in relative error. `held` divides by the attenuation of a first-order hold. The first
/// order + 1 moments are exact, and so is the behavior at rest.
std::vector<double> derivative_taps(int order, double advance, bool held = false) {
  constexpr int kLength = 2 * kHalfLength + 1;
  Eigen::MatrixXd x(2 * kGridPoints, kLength);
  Eigen::VectorXd y(2 * kGridPoints);
  for (int i = 0; i < kGridPoints; ++i) {
    const double w = M_PI / 2 * (i + 0.5) / kGridPoints;
    const double hold = held ? std::pow(std::sin(w / 2) / (w / 2), 2) : 1;
    const double scale = hold * std::pow(w, -order);
    const double phase = w * advance + order * M_PI / 2;
    for (int k = -kHalfLength; k <= kHalfLength; ++k) {
      x(2 * i, k + kHalfLength) = scale * std::cos(w * k);
      x(2 * i + 1, k + kHalfLength) = -scale * std::sin(w * k);
    }
    y[2 * i] = std::cos(phase);
    y[2 * i + 1] = std::sin(phase);
  }
  Eigen::MatrixXd moments(order + 1, kLength);
  Eigen::VectorXd wanted = Eigen::VectorXd::Zero(order + 1);
  for (int power = 0; power <= order; ++power)
    for (int k = -kHalfLength; k <= kHalfLength; ++k)
      moments(power, k + kHalfLength) = std::pow(-static_cast<double>(k), power);
  wanted[order] = order == 2 ? 2 : 1;
  const Eigen::VectorXd taps = constrained_fit(x, y, moments, wanted);
  return {taps.data(), taps.data() + taps.size()};
}

/// Returns `taps` convolved with (1 + z^-1)^2 / 4.
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

DerivativeTriple matched_triple(double rate_hz, double advance) {
  DerivativeTriple triple{derivative_taps(0, advance), derivative_taps(1, advance),
                          derivative_taps(2, advance), kHalfLength + 1.0};
  for (double& tap : triple.first) tap *= rate_hz;
  for (double& tap : triple.second) tap *= rate_hz * rate_hz;
  for (std::vector<double>* taps : {&triple.value, &triple.first, &triple.second})
    *taps = with_numerator(*taps);
  return triple;
}

DerivativeTriple held_triple(double rate_hz, double advance) {
  DerivativeTriple triple = matched_triple(rate_hz, advance);
  triple.held_first = derivative_taps(1, advance, true);
  triple.held_second = derivative_taps(2, advance, true);
  for (double& tap : triple.held_first) tap *= rate_hz;
  for (double& tap : triple.held_second) tap *= rate_hz * rate_hz;
  for (std::vector<double>* taps : {&triple.held_first, &triple.held_second})
    *taps = with_numerator(*taps);
  return triple;
}

DerivativeTriple trapezoid_triple(double rate_hz) {
  return {{0.25, 0.5, 0.25},
          {rate_hz / 2, 0, -rate_hz / 2},
          {rate_hz * rate_hz, -2 * rate_hz * rate_hz, rate_hz * rate_hz},
          1.0};
}

OscillatorSection::OscillatorSection(double corner_hz, double damping, double rate_hz) {
  const double w = std::tan(M_PI * corner_hz / rate_hz);
  const double norm = 1 / (1 + 2 * damping * w + w * w);
  a1 = 2 * (w * w - 1) * norm;
  a2 = (1 - 2 * damping * w + w * w) * norm;
  gain = 4 * w * w * norm;
}

}  // namespace framewatch::estimator
