#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "estimator/gap/running_model.h"

namespace framewatch::estimator {

/// The gain of white noise from the base through a model, and through the filters alone: sums of
/// squares of their impulse responses. The nonlinear laws of elements are left out, because noise
/// is small. Computed a few instants per call, so that no instant is late.
class NoisePath {
 public:
  NoisePath(const Structure& structure, const ParameterTable& table, const GapModel& model,
            double rate_hz, double high_pass_hz);

  /// Computes the next few instants.
  void advance();
  bool known() const { return direction_ == 2; }
  /// Variance of a filtered axis per variance of its samples.
  double own() const { return own_; }
  /// Variance at the degrees of freedom per variance of the base's samples, x and y; known() only.
  const Eigen::MatrixX2d& base() const { return base_; }

  template <typename Archive>
  void archive(Archive& a) {
    std::vector<double> base(base_.data(), base_.data() + base_.size());
    a(model_);
    a.within(direction_, 0, 2);
    a.within(instant_, 0, instants_ - 1);
    a.finite(base);
    if constexpr (Archive::kReading) std::copy(base.begin(), base.end(), base_.data());
  }

 private:
  RunningModel model_;
  int instants_;  ///< of a response
  int direction_ = 0, instant_ = 0;
  double own_;
  Eigen::MatrixX2d base_;
};

}  // namespace framewatch::estimator
