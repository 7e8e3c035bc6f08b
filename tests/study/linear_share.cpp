// SPDX-License-Identifier: MIT
#include "tests/study/linear_share.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "estimator/simulate/linear_building.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/study/study_record.h"

namespace framewatch::study {
namespace {

constexpr double kChange = 0.01;  ///< of a parameter, for its derivative
constexpr double kMassError = 0.01;
constexpr double kRidge = 1e-9;
constexpr int kSteps = 6;          ///< of Gauss-Newton
constexpr double kDamping = 1e-3;  ///< of the stiffness
constexpr int kStepsToTheEnd = 8, kTries = 5;
constexpr double kEnded = 0.98;  ///< share of the cost above which a step is the last

Eigen::VectorXd stacked(const Eigen::MatrixXd& m) {
  return Eigen::Map<const Eigen::VectorXd>(m.data(), m.size());
}

/// Returns the largest deformations of the linear building.
Peaks find_peaks(const StudyCase& c) {
  const StudyBuilding& b = c.building;
  const estimator::ParameterTable table = b.table();
  const double step_s = 1 / c.options.rate_hz;
  estimator::LinearBuilding building(b.truth, table, b.theta, step_s);
  const std::vector<estimator::Element> all = elements(b.truth, table);
  Peaks out;
  out.seconds = c.options.seconds;
  out.deformation = out.rate = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(all.size()));
  out.accel_rms = Eigen::VectorXd::Zero(b.truth.degrees_of_freedom());
  const auto ground = [&](int i) {
    return Eigen::Vector2d(c.motions[0].x.at(i * step_s), c.motions[0].y.at(i * step_s));
  };
  const int steps = static_cast<int>(c.options.seconds * c.options.rate_hz);
  for (int i = 0; i < steps; ++i) {
    building.advance(ground(i), ground(i + 1));
    const Eigen::VectorXd d = building.disp_rel(), v = building.vel_rel();
    out.accel_rms += building.accel_abs().cwiseAbs2() / steps;
    for (const estimator::Element& e : all) {
      double deformation = 0, rate = 0;
      for (const auto& [dof, coefficient] : e.b) {
        deformation += coefficient * d[dof];
        rate += coefficient * v[dof];
      }
      out.deformation[e.stiffness] = std::max(out.deformation[e.stiffness], std::abs(deformation));
      out.rate[e.stiffness] = std::max(out.rate[e.stiffness], std::abs(rate));
    }
  }
  out.accel_rms = out.accel_rms.cwiseSqrt();
  const std::vector<double> hz = natural_frequencies_hz(b.truth, table, b.theta);
  out.first_mode_hz = hz.front();
  out.last_mode_hz = hz.back();
  return out;
}

}  // namespace

LinearShare::LinearShare(const StudyCase& c) : case_(c), peaks_(find_peaks(c)) {
  for (const estimator::SensorAxis& axis : c.building.axes) base_axes_ += axis.story == 0;
  linear_ = clean_record(c, 0);
  const Eigen::Index above = linear_.cols() - base_axes_;
  derivatives_ = derivatives_at(c, stacked(linear_.rightCols(above)));
  norms_ = derivatives_.colwise().norm();
  for (Eigen::Index u = 0; u < unknowns(); ++u)
    if (norms_[u] > 0) derivatives_.col(u) /= norms_[u];

  StudyCase shaken = c;
  estimator::Random random(c.options.seed, 77);
  estimator::GroundMotion* along[] = {&shaken.motions[0].x, &shaken.motions[0].y};
  for (Eigen::Index i = 0; i < base_axes_; ++i) {
    estimator::GroundMotion& motion = *along[i % 2];
    motion.step_s = 1 / c.options.rate_hz;
    // Straight lines between samples lose a third of their power.
    const double rms =
        std::sqrt(1.5 * linear_.col(i).squaredNorm() / static_cast<double>(linear_.rows()));
    motion.accel.assign(static_cast<std::size_t>(linear_.rows()) + 2, 0.0);
    for (double& value : motion.accel) value = rms * random.normal();
  }
  amplified_ = clean_record(shaken, 0).rightCols(above).norm() / linear_.rightCols(above).norm();

  hold_masses();
  gram_ = derivatives_.transpose() * derivatives_;
  gram_.diagonal() += held_;
  gram_.diagonal().array() += kRidge;
}

Eigen::VectorXd LinearShare::response(const StudyCase& c) const {
  return stacked(clean_record(c, 0).rightCols(linear_.cols() - base_axes_));
}

/// With respect to relative changes.
Eigen::MatrixXd LinearShare::derivatives_at(const StudyCase& c,
                                            const Eigen::VectorXd& response) const {
  Eigen::MatrixXd out(response.size(), unknowns());
  for (Eigen::Index u = 0; u < unknowns(); ++u) {
    StudyCase changed = c;
    value(changed, u) *= 1 + kChange;
    out.col(u) = (this->response(changed) - response) / kChange;
  }
  return out;
}

double& LinearShare::value(StudyCase& c, Eigen::Index unknown) const {
  const Eigen::Index parameters = case_.building.theta.size();
  return unknown < parameters
             ? c.hidden.theta[unknown]
             : c.building.truth.node_mass[static_cast<std::size_t>(unknown - parameters)];
}

void LinearShare::hold_masses() {
  held_ = Eigen::VectorXd::Zero(unknowns());
  const Eigen::Index above = linear_.cols() - base_axes_;
  const double noise = noise_floor(case_.options.noise_ratio) * linear_.rightCols(above).norm() /
                       std::sqrt(static_cast<double>(derivatives_.rows()));
  for (Eigen::Index u = case_.building.theta.size(); u < unknowns(); ++u)
    if (norms_[u] > 0) held_[u] = std::pow(noise / (kMassError * norms_[u]), 2);
}

double LinearShare::noise_floor(double ratio) const {
  return ratio * std::hypot(1.0, amplified_);
}

double LinearShare::unexplained(const Eigen::MatrixXd& accel, bool worst_channel,
                                double enough) const {
  const Eigen::Index above = linear_.cols() - base_axes_;
  Eigen::VectorXd difference = stacked((accel - linear_).rightCols(above));
  const Eigen::LDLT<Eigen::MatrixXd> solver(gram_);
  Eigen::MatrixXd damped = gram_;
  damped.diagonal().array() += kDamping;
  const Eigen::LDLT<Eigen::MatrixXd> cautious(damped);
  StudyCase fitted = case_;
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(unknowns());
  const auto pull = [&] {
    return Eigen::VectorXd(derivatives_.transpose() * difference - held_.cwiseProduct(moved));
  };
  Eigen::VectorXd rest = difference - derivatives_ * solver.solve(pull());
  for (int i = 0; i < kSteps && rest.norm() > enough * accel.rightCols(above).norm(); ++i) {
    const Eigen::VectorXd fit = cautious.solve(pull());
    StudyCase start = case_;
    for (Eigen::Index u = 0; u < unknowns(); ++u) {
      if (norms_[u] == 0) continue;
      moved[u] = std::max(-0.9 * norms_[u], moved[u] + fit[u]);
      value(fitted, u) = value(start, u) * (1 + moved[u] / norms_[u]);
    }
    difference = stacked((accel - clean_record(fitted, 0)).rightCols(above));
    const Eigen::VectorXd now = difference - derivatives_ * solver.solve(pull());
    if (now.norm() < rest.norm()) rest = now;
  }
  return share_of(rest, accel, worst_channel);
}

double LinearShare::unexplained_at_the_end(const Eigen::MatrixXd& accel, bool worst_channel) const {
  const Eigen::VectorXd measured = stacked(accel.rightCols(linear_.cols() - base_axes_));
  Eigen::VectorXd changes = Eigen::VectorXd::Zero(unknowns());  // relative
  // Masses are weighted by hold_masses(), in relative changes.
  const Eigen::VectorXd held = held_.cwiseProduct(norms_.cwiseAbs2());
  const auto building_of = [&](const Eigen::VectorXd& by) {
    StudyCase out = case_;
    for (Eigen::Index u = 0; u < unknowns(); ++u) value(out, u) *= std::clamp(1 + by[u], 0.1, 10.0);
    return out;
  };
  const auto cost_of = [&](const Eigen::VectorXd& rest, const Eigen::VectorXd& by) {
    return rest.squaredNorm() + held.dot(by.cwiseAbs2());
  };
  Eigen::VectorXd rest = measured - response(case_);
  double cost = cost_of(rest, changes), damping = kDamping;
  for (int i = 0; i < kStepsToTheEnd; ++i) {
    const StudyCase at = building_of(changes);
    // Converts factors on the present building to factors on the original one.
    Eigen::MatrixXd d = derivatives_at(at, measured - rest);
    for (Eigen::Index u = 0; u < unknowns(); ++u) d.col(u) /= std::clamp(1 + changes[u], 0.1, 10.0);
    Eigen::MatrixXd normal = d.transpose() * d;
    normal.diagonal() += held;
    const Eigen::VectorXd right = d.transpose() * rest - held.cwiseProduct(changes);
    const double before = cost;
    for (int tries = 0; tries < kTries; ++tries) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() *= 1 + damping;
      damped.diagonal().array() += kRidge * normal.diagonal().maxCoeff();
      const Eigen::VectorXd next = changes + damped.ldlt().solve(right);
      const Eigen::VectorXd left = measured - response(building_of(next));
      if (left.allFinite() && cost_of(left, next) < cost) {
        changes = next;
        rest = left;
        cost = cost_of(left, next);
        damping *= 0.1;
        break;
      }
      damping *= 10;
    }
    if (cost > kEnded * before) break;
  }
  return share_of(rest, accel, worst_channel);
}

double LinearShare::share_of(const Eigen::VectorXd& rest, const Eigen::MatrixXd& accel,
                             bool worst_channel) const {
  const Eigen::Index above = linear_.cols() - base_axes_;
  const double base =
      (accel - linear_).leftCols(base_axes_).norm() / linear_.leftCols(base_axes_).norm();
  if (!worst_channel) return std::hypot(rest.norm() / accel.rightCols(above).norm(), base);
  double worst = base;
  for (Eigen::Index i = 0; i < above; ++i) {
    const double share =
        rest.segment(i * accel.rows(), accel.rows()).norm() / accel.col(base_axes_ + i).norm();
    worst = std::max(worst, share);
  }
  return worst;
}

}  // namespace framewatch::study
