#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/linear_operation.h"

namespace framewatch::estimator {

/// The operations D of every bin of a segment, equations x axes, docs/equations.md (31). Those of a
/// large building are computed on demand because of their memory.
class Operations {
 public:
  Operations() = default;
  /// D = mass - stiffness / w^2 - j damping / w + additions, all equations x axes; w: rad/s.
  Operations(const Eigen::MatrixXd& mass, const Eigen::MatrixXd& stiffness,
             const Eigen::MatrixXd& damping, std::vector<LinearOperation> additions,
             Eigen::VectorXd w);

  bool empty() const { return w_.size() == 0; }
  Eigen::Index equations() const { return mass_.rows(); }
  Eigen::MatrixXcd operator[](std::size_t bin) const {
    return kept_.empty() ? made(static_cast<Eigen::Index>(bin)) : kept_[bin];
  }

  /// Returns D motion for every bin: equations x bins. motion: axes x bins.
  Eigen::MatrixXcd times(const Eigen::MatrixXcd& motion) const;
  /// Returns D^H forces for every bin: axes x bins. forces: equations x bins.
  Eigen::MatrixXcd adjoint_times(const Eigen::MatrixXcd& forces) const;
  /// Returns an axis' column for every bin: equations x bins.
  Eigen::MatrixXcd of_axis(Eigen::Index axis) const;

 private:
  Eigen::MatrixXcd made(Eigen::Index bin) const;
  Eigen::MatrixXcd product(const Eigen::MatrixXcd& columns, bool adjoint) const;

  Eigen::MatrixXd mass_, stiffness_, damping_;
  std::vector<LinearOperation> additions_;
  Eigen::VectorXd w_;
  std::vector<Eigen::MatrixXcd> kept_;
};

}  // namespace framewatch::estimator
