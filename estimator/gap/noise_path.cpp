#include "estimator/gap/noise_path.h"

#include <cmath>

#include "estimator/simulate/element_law.h"

namespace framewatch::estimator {
namespace {

constexpr int kInstantsPerCall = 4;
constexpr int kFilled = 64;  ///< instants after which a filter gives values
constexpr int kFilterInstants = 10'000;

GapModel without_laws(const GapModel& model, const Structure& structure) {
  GapModel out = model;
  std::erase_if(out.effects, [&](const Effect& e) { return make_law(e, structure) != nullptr; });
  return out;
}

/// Sum of squares of the impulse response of drift control and filter.
double filtered_variance(double rate_hz, double high_pass_hz) {
  DriftControlledIntegrator filter({matched_triple(rate_hz)}, HighPass(high_pass_hz, rate_hz));
  double sum = 0;
  for (int i = -kFilled; i < kFilterInstants; ++i) {
    filter.push({i == 0 ? 1.0 : 0.0});
    sum += filter.value(0) * filter.value(0);
  }
  return sum;
}

}  // namespace

NoisePath::NoisePath(const Structure& structure, const ParameterTable& table, const GapModel& model,
                     const MeasuredInputs& inputs, double rate_hz, double high_pass_hz)
    : inputs_(inputs),
      model_(structure, table, without_laws(model, structure), inputs.inputs, rate_hz, high_pass_hz,
             Eigen::VectorXd::Zero(inputs.from_axes.rows())),
      instants_(kFilled + RunningModel::kDelay +
                static_cast<int>(std::ceil(model_.settle_s() * rate_hz))),
      own_(filtered_variance(rate_hz, high_pass_hz)),
      gain_(Eigen::MatrixXd::Zero(structure.degrees_of_freedom(), inputs.from_axes.cols())) {}

void NoisePath::advance() {
  for (int i = 0; i < kInstantsPerCall && !known(); ++i) {
    if (instant_ == 0) model_.restart();
    const Eigen::Index axis = inputs_.used[static_cast<std::size_t>(next_)];
    model_.push(inputs_.from_axes.col(axis) * (instant_ == kFilled ? 1.0 : 0.0));
    for (Eigen::Index d = 0; d < gain_.rows(); ++d) {
      const double accel = model_.accel_abs(static_cast<int>(d));
      gain_(d, axis) += accel * accel;
    }
    if (++instant_ < instants_) continue;
    instant_ = 0;
    ++next_;
  }
}

}  // namespace framewatch::estimator
