#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/refine/measured_groups.h"
#include "estimator/refine/segment_likelihood.h"

namespace framewatch::estimator {

/// That of a building with sensors on some floors: D is That' (s^2 M + s C + K) That / s^2 of the
/// measured floors, That = [1; T] with the motion T of the others by theirs. Its derivative by a
/// parameter is That' times the parameter's part times That: that of T drops out.
class GroupLikelihood : public SegmentLikelihood {
 public:
  /// Both must outlive this.
  GroupLikelihood(const MeasuredGroups& groups, const Spectrum& spectrum, EndTerms terms);

 private:
  /// What a parameter adds in one bin: act sense times its force per displacement.
  struct Part {
    Eigen::MatrixXcd act;    ///< equations x springs
    Eigen::MatrixXcd sense;  ///< springs x axes
  };
  bool operate(const Eigen::VectorXd& theta) override;
  void gather(Eigen::Index b, const Eigen::VectorXcd& force, const Eigen::VectorXcd& motion,
              bool exact_motion, LikelihoodPoint& point, Eigen::MatrixXd& cross) const override;
  /// Of the inner coordinates under forces on them, the measured ones at rest.
  Eigen::MatrixXcd inner_motion(const Eigen::MatrixXcd& dynamic,
                                const Eigen::MatrixXcd& forces) const;
  std::vector<Part> parts_of(Eigen::Index b) const;

  const MeasuredGroups& groups_;
  Eigen::MatrixXd momenta_;               ///< of the inner modes whose state at the ends is unknown
  std::vector<Eigen::MatrixXcd> motion_;  ///< by bin: all coordinates by the measured ones
  std::vector<Eigen::MatrixXcd> free_;    ///< by bin: all coordinates by the modes' ends
};

}  // namespace framewatch::estimator
