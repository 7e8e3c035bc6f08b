// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/modal_system.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "estimator/numeric/complex.h"
#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Returns (e^x - 1) / x and (e^x - 1 - x) / x^2.
std::pair<Complex, Complex> hold_weights(Complex x) {
  if (std::abs(x) < 1e-2) {
    const Complex one = 1.0 + x * (0.5 + x * (1.0 / 6 + x * (1.0 / 24 + x / 120.0)));
    const Complex two = 0.5 + x * (1.0 / 6 + x * (1.0 / 24 + x * (1.0 / 120 + x / 720.0)));
    return {one, two};
  }
  const Complex e = std::exp(x);
  return {(e - 1.0) / x, (e - 1.0 - x) / (x * x)};
}

}  // namespace

ModalSystem::ModalSystem(const MatrixXd& mass, const MatrixXd& damping, const MatrixXd& stiffness,
                         const MatrixXd& inputs, double step_s)
    : coordinates_(mass.rows()) {
  const Index n = coordinates_;
  const MatrixXd per_mass = inverse(mass);
  // Velocities are in units of a typical frequency, which keeps the eigenvectors well conditioned.
  const double scale =
      std::sqrt(std::max(1e-12, (per_mass * stiffness).trace() / static_cast<double>(n)));
  MatrixXd a = MatrixXd::Zero(2 * n, 2 * n);
  a.topRightCorner(n, n).diagonal().setConstant(scale);
  a.bottomLeftCorner(n, n) = -per_mass * stiffness / scale;
  a.bottomRightCorner(n, n) = -per_mass * damping;
  MatrixXd b = MatrixXd::Zero(2 * n, inputs.cols());
  b.bottomRows(n) = per_mass * inputs / scale;

  const ComplexEigen modes_of_all = general_eigen(a);
  good_ = modes_of_all.good && a.allFinite();
  if (!good_) return;
  const MatrixXcd& vectors = modes_of_all.vectors;
  const ComplexLu into_modes(vectors);
  const MatrixXcd modal_inputs = into_modes.solve(MatrixXcd(b.cast<Complex>()));
  MatrixXd units = MatrixXd::Identity(2 * n, 2 * n);
  units.bottomRows(n) /= scale;
  const MatrixXcd modal_units = into_modes.solve(MatrixXcd(units.cast<Complex>()));
  std::vector<Index> kept;
  for (Index i = 0; i < 2 * n; ++i)
    if (modes_of_all.values[i].imag() >= 0) kept.push_back(i);
  const auto modes = static_cast<Index>(kept.size());
  shapes_.resize(2 * n, modes);
  turn_.resize(modes);
  first_.resize(modes, inputs.cols());
  last_.resize(modes, inputs.cols());
  entry_.resize(modes, 2 * n);
  of_first_.resize(modes);
  of_last_.resize(modes);
  for (Index m = 0; m < modes; ++m) {
    const Complex lambda = modes_of_all.values[kept[static_cast<std::size_t>(m)]];
    const double weight = lambda.imag() > 0 ? 2.0 : 1.0;
    shapes_.col(m) = weight * vectors.col(kept[static_cast<std::size_t>(m)]);
    turn_[m] = std::exp(lambda * step_s);
    entry_.row(m) = modal_units.row(kept[static_cast<std::size_t>(m)]);
    const auto [one, two] = hold_weights(lambda * step_s);
    of_last_[m] = step_s * two;
    of_first_[m] = step_s * (one - two);
    last_.row(m) = of_last_[m] * modal_inputs.row(kept[static_cast<std::size_t>(m)]);
    first_.row(m) = of_first_[m] * modal_inputs.row(kept[static_cast<std::size_t>(m)]);
  }
  shapes_.bottomRows(n) *= scale;
  good_ = shapes_.allFinite() && turn_.allFinite() && last_.allFinite() &&
          (turn_.cwiseAbs().array() < 1 + 1e-3).all();
  reset();
}

Index ModalSystem::add_input(const VectorXd& per_mass) {
  const Eigen::VectorXcd modal = entry_.rightCols(coordinates_) * per_mass.cast<Complex>();
  const Index at = last_.cols();
  first_.conservativeResize(Eigen::NoChange, at + 1);
  last_.conservativeResize(Eigen::NoChange, at + 1);
  first_.col(at) = of_first_.cwiseProduct(modal);
  last_.col(at) = of_last_.cwiseProduct(modal);
  return at;
}

void ModalSystem::reset() {
  state_ = Eigen::VectorXcd::Zero(turn_.size());
  before_ = state_;
}

void ModalSystem::start(const VectorXd& displacement, const VectorXd& velocity) {
  VectorXd motion(2 * coordinates_);
  motion << displacement, velocity;
  state_ = entry_ * motion.cast<Complex>();
  before_.setZero();
}

void ModalSystem::predict(const VectorXd& now) {
  state_ = turn_.cwiseProduct(state_) + before_;
  before_.setZero();
  for (Index i = 0; i < now.size(); ++i) {
    if (now[i] == 0) continue;
    state_ += now[i] * last_.col(i);
    before_ += now[i] * first_.col(i);
  }
}

void ModalSystem::correct(const VectorXd& now) {
  for (Index i = 0; i < now.size(); ++i) {
    if (now[i] == 0) continue;
    state_ += now[i] * last_.col(i);
    before_ += now[i] * first_.col(i);
  }
}

ModalSystem::Observer ModalSystem::observe(const VectorXd& row) const {
  Observer out;
  out.displacement = row.transpose() * shapes_.topRows(coordinates_);
  out.velocity = row.transpose() * shapes_.bottomRows(coordinates_);
  out.displacement_gain = (out.displacement * last_).real();
  out.velocity_gain = (out.velocity * last_).real();
  return out;
}

}  // namespace framewatch::estimator
