#include "estimator/gap/noise_path.h"

#include <cmath>

#include "estimator/simulate/element_law.h"
#include "estimator/simulate/make_law.h"

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
                     double rate_hz, double high_pass_hz)
    : model_(structure, table, without_laws(model, structure), rate_hz, high_pass_hz),
      instants_(kFilled + RunningModel::kDelay +
                static_cast<int>(std::ceil(model_.settle_s() * rate_hz))),
      own_(filtered_variance(rate_hz, high_pass_hz)),
      base_(Eigen::MatrixX2d::Zero(structure.degrees_of_freedom(), 2)) {}

void NoisePath::advance() {
  for (int i = 0; i < kInstantsPerCall && !known(); ++i) {
    if (instant_ == 0) model_.restart();
    Eigen::Vector2d base(0, 0);
    base[direction_] = instant_ == kFilled ? 1 : 0;
    model_.push(base);
    for (Eigen::Index d = 0; d < base_.rows(); ++d) {
      const double accel = model_.accel_abs(static_cast<int>(d));
      base_(d, direction_) += accel * accel;
    }
    if (++instant_ < instants_) continue;
    instant_ = 0;
    ++direction_;
  }
}

}  // namespace framewatch::estimator
