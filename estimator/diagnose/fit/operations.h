#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/linear_operation.h"

namespace framewatch::estimator {

/// The operations D of every bin of a segment, equations x axes, docs/equations.md (31). Of a large
/// building they are made when they are asked for: they would fill memories.
class Operations {
 public:
  Operations() = default;
  /// D = mass - stiffness / w^2 - j damping / w + additions, all equations x axes; w: rad/s.
  Operations(Eigen::MatrixXd mass, Eigen::MatrixXd stiffness, Eigen::MatrixXd damping,
             std::vector<LinearOperation> additions, Eigen::VectorXd w)
      : mass_(std::move(mass)),
        stiffness_(std::move(stiffness)),
        damping_(std::move(damping)),
        additions_(std::move(additions)),
        w_(std::move(w)) {
    constexpr Eigen::Index kMostKept = 1'000'000;  // numbers
    const Eigen::Index bins = w_.size();
    if (mass_.size() * bins > kMostKept) return;
    for (Eigen::Index b = 0; b < bins; ++b) kept_.push_back(made(b));
  }

  bool empty() const { return w_.size() == 0; }
  Eigen::Index equations() const { return mass_.rows(); }
  Eigen::MatrixXcd operator[](std::size_t bin) const {
    return kept_.empty() ? made(static_cast<Eigen::Index>(bin)) : kept_[bin];
  }

 private:
  Eigen::MatrixXcd made(Eigen::Index bin) const {
    const double w = w_[bin];
    Eigen::MatrixXcd out(mass_.rows(), mass_.cols());
    out.real() = mass_ - stiffness_ / (w * w);
    out.imag() = damping_ / -w;
    for (const LinearOperation& addition : additions_) addition.add_to(w, out);
    return out;
  }

  Eigen::MatrixXd mass_, stiffness_, damping_;
  std::vector<LinearOperation> additions_;
  Eigen::VectorXd w_;
  std::vector<Eigen::MatrixXcd> kept_;
};

}  // namespace framewatch::estimator
