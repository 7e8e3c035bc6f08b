// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/identify/groups/reduced_building.h"
#include "estimator/refine/segment_likelihood.h"
#include "estimator/refine/spectrum.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// The equations of motion of the measured floors of a building with sensors on some floors; the
/// motion of the floors between follows from theirs. docs/equations.md, groups of stories.
struct MeasuredGroups {
  ReducedBuilding building;
  Eigen::VectorXd designed;  ///< parameters used to form the building's parts
  /// By parameter: F with F F' its part of the building's stiffness or damping, for the rows that
  /// are not zero, which `touched` lists.
  std::vector<Eigen::MatrixXd> factors;
  std::vector<std::vector<Eigen::Index>> touched;
  /// Forces on all coordinates per momentum of each mode of the inner coordinates with the measured
  /// ones held, and the modes' frequencies, Hz.
  Eigen::MatrixXd momenta;
  Eigen::VectorXd inner_hz;
  Eigen::VectorXd variance;  ///< of one sample's white noise, per axis, (m/s^2)^2
  Eigen::VectorXd delay;     ///< s, per axis
  bool noise_known =
      true;  ///< false: kDefaultNoiseDensity is used for axes without a noise density

  Eigen::Index equations() const { return building.rows(); }
  Eigen::Index parameters() const { return designed.size(); }
  Eigen::Index axes() const { return building.from_axes.cols(); }
};

/// config: grouped parameters. Returns no equations if the base is not measured in a direction that
/// is measured above it.
MeasuredGroups measured_groups(const PipelineConfig& config);

/// Returns the band from 0.4 times the lowest natural frequency of the building of theta to twice
/// the highest frequency of a measured floor between neighbors at rest, at most 0.4 of the sampling
/// rate.
Band groups_band(const MeasuredGroups& groups, const Eigen::VectorXd& theta, double rate_hz);

/// The likelihood of a building with sensors on some floors. D is That' (s^2 M + s C + K) That /
/// s^2 for the measured floors, That = [1; T] with the motion T of the other floors by theirs. Its
/// derivative by a parameter is That' times the parameter's part times That; the derivative of T
/// cancels.
class GroupLikelihood : public SegmentLikelihood {
 public:
  /// Both arguments must outlive this.
  GroupLikelihood(const MeasuredGroups& groups, const Spectrum& spectrum, EndTerms terms);

 private:
  /// The derivative by a parameter in one bin: act sense times its force per displacement.
  struct Part {
    Eigen::MatrixXcd act;    ///< equations x springs
    Eigen::MatrixXcd sense;  ///< springs x axes
  };
  bool operate(const Eigen::VectorXd& theta) override;
  void gather(Eigen::Index b, const Eigen::VectorXcd& force, const Eigen::VectorXcd& motion,
              bool exact_motion, LikelihoodPoint& point, Eigen::MatrixXd& cross) const override;
  /// Returns the motion of the inner coordinates under forces on them, with the measured ones at
  /// rest.
  Eigen::MatrixXcd inner_motion(const Eigen::MatrixXcd& dynamic,
                                const Eigen::MatrixXcd& forces) const;
  std::vector<Part> parts_of(Eigen::Index b) const;

  const MeasuredGroups& groups_;
  Eigen::MatrixXd momenta_;               ///< of the inner modes whose state at the ends is unknown
  std::vector<Eigen::MatrixXcd> motion_;  ///< by bin: all coordinates by the measured ones
  std::vector<Eigen::MatrixXcd> free_;    ///< by bin: all coordinates by the modes' ends
};

}  // namespace framewatch::estimator
