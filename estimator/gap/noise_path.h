#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/gap/measured_inputs.h"
#include "estimator/gap/running_model.h"

namespace framewatch::estimator {

/// The gain of white noise of the axes that show the inputs through a model, and through the
/// filters alone: sums of squares of their impulse responses. The nonlinear laws of elements are
/// left out, because noise is small. Computed a few instants per call, so that no instant is late.
class NoisePath {
 public:
  NoisePath(const Structure& structure, const ParameterTable& table, const GapModel& model,
            const MeasuredInputs& inputs, double rate_hz, double high_pass_hz);

  /// Computes the next few instants.
  void advance();
  bool known() const { return next_ == static_cast<int>(inputs_.used.size()); }
  /// Variance of a filtered axis per variance of its samples.
  double own() const { return own_; }
  /// Degrees of freedom x all axes: variance per variance of the axis' samples; known() only.
  const Eigen::MatrixXd& inputs() const { return gain_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(model_);
    a.within(next_, 0, static_cast<double>(inputs_.used.size()));
    a.within(instant_, 0, instants_ - 1);
    a.finite(gain_);
  }

 private:
  MeasuredInputs inputs_;
  RunningModel model_;
  int instants_;  ///< of a response
  int next_ = 0, instant_ = 0;
  double own_;
  Eigen::MatrixXd gain_;
};

}  // namespace framewatch::estimator
