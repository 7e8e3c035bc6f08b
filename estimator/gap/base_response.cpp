// SPDX-License-Identifier: MIT
#include "estimator/gap/base_response.h"

#include <algorithm>

namespace framewatch::estimator {

BaseResponse::BaseResponse(const Structure& structure, const ParameterTable& table,
                           const Eigen::VectorXd& theta, const MeasuredInputs& inputs,
                           const std::vector<SeenMotion>& seen, double rate_hz)
    : building_(structure, table, theta, inputs.inputs, 1 / rate_hz),
      rest_(building_.motion()),
      axes_(inputs.used),
      from_axes_(inputs.from_axes),
      seen_(seen) {}

Eigen::MatrixXd BaseResponse::of(Eigen::Index axis, const Eigen::VectorXd& reading) {
  (void)building_.resume(rest_);
  Eigen::MatrixXd out(reading.size(), static_cast<Eigen::Index>(seen_.size()));
  Eigen::VectorXd before = Eigen::VectorXd::Zero(from_axes_.rows()), after = before;
  for (Eigen::Index i = 0; i < reading.size(); ++i) {
    after = from_axes_.col(axis) * reading[i];
    building_.drive(before, after);
    before.swap(after);
    for (std::size_t a = 0; a < seen_.size(); ++a) {
      double sum = 0;
      for (const auto& [dof, weight] : seen_[a]) sum += weight * building_.accel_abs()[dof];
      out(i, static_cast<Eigen::Index>(a)) = sum;
    }
  }
  return out;
}

}  // namespace framewatch::estimator
