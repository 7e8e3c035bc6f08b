#include "estimator/diagnose/gap.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include <Eigen/LU>

namespace framewatch {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

Gap gap_of(const Plant& plant, const Stretch& stretch, const Whitened& system) {
  const Index n = plant.equations(), axes = plant.axis_count(), bins = system.bins();
  const MatrixXd back =
      plant.motion.transpose() * (plant.motion * plant.motion.transpose()).inverse();
  MatrixXd seen = MatrixXd::Zero(axes, n);  // motion of the coordinates -> axes
  VectorXd is_base = VectorXd::Zero(axes);
  for (Index a = 0; a < axes; ++a) {
    const SensorAxis& axis = plant.axes[static_cast<std::size_t>(a)];
    if (axis.story == 0)
      is_base[a] = 1;
    else
      seen.row(a) = plant.constraint.row(plant.structure.dof(axis.story, axis.frame));
  }
  Gap out;
  out.difference = MatrixXcd::Zero(axes, bins);
  VectorXd noise = VectorXd::Zero(axes), power = VectorXd::Zero(axes), error = noise;
  const VectorXd variance = static_cast<double>(stretch.intervals()) * stretch.variance;
  for (Index b = 0; b < bins; ++b) {
    const auto at = static_cast<std::size_t>(b);
    VectorXcd e(n);
    e.real() = system.rest.segment(2 * n * b, n);
    e.imag() = system.rest.segment(2 * n * b + n, n);
    e = system.factor[at].triangularView<Eigen::Lower>() * e;
    const MatrixXcd own = system.operation[at] * back.cast<Complex>();
    const Eigen::PartialPivLU<MatrixXcd> solver(own);
    const VectorXcd difference = solver.solve(e);
    const MatrixXcd from_base =
        solver.solve(MatrixXcd(system.operation[at] * is_base.cast<Complex>().asDiagonal()));
    out.difference.col(b) = seen.cast<Complex>() * difference;
    error += out.difference.col(b).cwiseAbs2();
    const MatrixXcd carried = seen.cast<Complex>() * from_base;
    noise += carried.cwiseAbs2() * variance + (1 - is_base.array()).matrix().cwiseProduct(variance);
    power += system.calibrated.col(b).cwiseAbs2().cwiseProduct((1 - is_base.array()).matrix());
  }
  out.axis = (error.array() / power.array().max(1e-300)).sqrt();
  out.floor = (noise.array() / power.array().max(1e-300)).sqrt();
  out.axis = (is_base.array() > 0).select(0.0, out.axis.array());
  out.floor = (is_base.array() > 0).select(0.0, out.floor.array());
  out.overall = std::sqrt(error.sum() / std::max(power.sum(), 1e-300));
  out.overall_floor = std::sqrt(noise.sum() / std::max(power.sum(), 1e-300));
  Index worst = 0;
  out.worst = out.axis.maxCoeff(&worst);
  out.worst_axis = static_cast<int>(worst);
  return out;
}

}  // namespace framewatch
