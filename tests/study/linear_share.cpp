#include "tests/study/linear_share.h"

#include <cmath>

#include <Eigen/Cholesky>

#include "estimator/simulate/linear_building.h"
#include "estimator/structure/matrices.h"
#include "tests/study/study_record.h"

namespace framewatch::study {
namespace {

constexpr double kChange = 0.01;  ///< of a parameter, for its derivative
constexpr double kRidge = 1e-9;

Eigen::VectorXd stacked(const Eigen::MatrixXd& m) {
  return Eigen::Map<const Eigen::VectorXd>(m.data(), m.size());
}

/// Largest deformations of the linear building.
Peaks find_peaks(const StudyCase& c) {
  const StudyBuilding& b = c.building;
  const ParameterTable table = b.table();
  const double step_s = 1 / c.options.rate_hz;
  LinearBuilding building(b.truth, table, b.theta, step_s);
  const std::vector<Element> all = elements(b.truth, table);
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
    for (const Element& e : all) {
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

LinearShare::LinearShare(const StudyCase& c) : peaks_(find_peaks(c)) {
  for (const SensorAxis& axis : c.building.axes) base_axes_ += axis.story == 0;
  linear_ = clean_record(c, 0);
  const Eigen::Index above = linear_.cols() - base_axes_;
  derivatives_.resize(linear_.rows() * above, c.building.theta.size());
  for (Eigen::Index p = 0; p < c.building.theta.size(); ++p) {
    StudyCase changed = c;
    changed.hidden.theta[p] *= 1 + kChange;
    derivatives_.col(p) = stacked((clean_record(changed, 0) - linear_).rightCols(above)) / kChange;
    const double norm = derivatives_.col(p).norm();
    if (norm > 0) derivatives_.col(p) /= norm;
  }
  gram_ = derivatives_.transpose() * derivatives_;
  gram_.diagonal().array() += kRidge;
}

double LinearShare::unexplained(const Eigen::MatrixXd& accel, bool worst_channel) const {
  const Eigen::Index above = linear_.cols() - base_axes_;
  const Eigen::VectorXd difference = stacked((accel - linear_).rightCols(above));
  // A wrong base channel is a wrong input: counted as what it would be on the channels above.
  const double base =
      (accel - linear_).leftCols(base_axes_).norm() / linear_.leftCols(base_axes_).norm();
  const Eigen::VectorXd fit = gram_.ldlt().solve(derivatives_.transpose() * difference);
  const Eigen::VectorXd rest = difference - derivatives_ * fit;
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
