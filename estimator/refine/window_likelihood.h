// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/refine/segment_likelihood.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The equation of motion (6) in terms of the sensor axes, docs/equations.md (31). With A the
/// spectra of the axes, e(w) = [mass + act diag(c_e / jw - k_e / w^2) sense] A(w) is zero for exact
/// motion. The ground motion is not assumed known: base axes are noisy like any other. For a force
/// axis `mass` holds minus its lever on the equations, and its "acceleration" is the force, N.
struct MeasuredBuilding {
  Eigen::MatrixXd mass;      ///< equations x axes, kg
  Eigen::MatrixXd act;       ///< equations x elements: directions of the elements' forces
  Eigen::MatrixXd sense;     ///< elements x axes: deformations from the axes' motion
  Eigen::VectorXd variance;  ///< of one sample's white noise, per axis, (m/s^2)^2
  Eigen::VectorXd delay;     ///< s, per axis
  bool noise_known = true;  ///< false: 1e-4 m/s^2/sqrt(Hz) is used for axes without a noise density

  Eigen::Index equations() const { return mass.rows(); }
  Eigen::Index elements() const { return act.cols(); }
  Eigen::Index axes() const { return sense.cols(); }
};

/// Returns nullopt when the equations need a motion that has no sensor. A base without sensors is
/// at rest if a force is measured. The motion of rigid floors is the weighted mean of their
/// sensors.
std::optional<MeasuredBuilding> measured_building(const Structure& structure,
                                                  const ParameterTable& table,
                                                  const std::vector<SensorAxis>& axes,
                                                  double rate_hz);

/// The likelihood of a building with a sensor on every frame of every floor; docs/equations.md
/// (31).
class WindowLikelihood : public SegmentLikelihood {
 public:
  /// Both arguments must outlive this.
  WindowLikelihood(const MeasuredBuilding& building, const Spectrum& spectrum, EndTerms terms);

 private:
  bool operate(const Eigen::VectorXd& theta) override;
  void gather(Eigen::Index b, const Eigen::VectorXcd& force, const Eigen::VectorXcd& motion,
              bool exact_motion, LikelihoodPoint& point, Eigen::MatrixXd& cross) const override;

  const MeasuredBuilding& building_;
};

}  // namespace framewatch::estimator
