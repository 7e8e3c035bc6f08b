// SPDX-License-Identifier: MIT
#include "estimator/gap/running_model.h"

#include <algorithm>
#include <cmath>

#include "estimator/numeric/kernels.h"
#include "estimator/simulate/building_model.h"
#include "estimator/simulate/linear_building.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/make_law.h"
#include "estimator/simulate/nonlinear_building.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::estimator {
namespace {

constexpr double kBias_s = 150;  ///< far slower than any motion
constexpr double kLeft = 0.01;   ///< remainder of a free vibration after settling
constexpr double kMinSettle_s = 2, kMaxSettle_s = 120;

std::vector<Effect> effects_of_building(const GapModel& model) {
  std::vector<Effect> effects;
  for (const Effect& e : model.effects)
    if (!is_channel_effect(e.kind) && e.kind != EffectKind::unmeasured_force) effects.push_back(e);
  return effects;
}

bool is_linear(const GapModel& model) {
  return !concerns_building(effects_of_building(model));
}

std::unique_ptr<DrivenBuilding> building_of(const Structure& structure, const ParameterTable& table,
                                            const GapModel& model, const Inputs& inputs,
                                            double step_s) {
  const std::vector<Effect> effects = effects_of_building(model);
  if (is_linear(model))
    return std::make_unique<LinearBuilding>(structure, table, model.theta, inputs, step_s);
  return std::make_unique<NonlinearBuilding>(structure, table, model.theta, effects, inputs,
                                             step_s);
}

/// Estimates the time to settle from the frames' share of damping in the first mode.
double settle_time(const Structure& structure, const ParameterTable& table,
                   const Eigen::VectorXd& theta) {
  const double w1 = 2 * M_PI * natural_frequencies_hz(structure, table, theta).front();
  double k = 0, c = 0;
  for (int i = 0; i < table.elements(); ++i) {
    if (table[i].frame < 0) continue;
    k += theta[i];
    c += theta[i + table.elements()];
  }
  const double decay = c / k * w1 * w1 / 2;
  return std::clamp(-std::log(kLeft) / decay, kMinSettle_s, kMaxSettle_s);
}

constexpr int kInstantsPerCall = 4;
constexpr int kFilled = 64;  ///< instants until a filter has values
constexpr int kFilterInstants = 10'000;

GapModel without_laws(const GapModel& model, const Structure& structure) {
  GapModel out = model;
  std::erase_if(out.effects, [&](const Effect& e) { return make_law(e, structure) != nullptr; });
  return out;
}

/// Returns the sum of squares of the impulse response of drift control and filter.
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

RunningModel::RunningModel(const Structure& structure, const ParameterTable& table,
                           const GapModel& model, const Inputs& inputs, double rate_hz,
                           double high_pass_hz, const Eigen::VectorXd& late)
    : steps_(steps_per_instant({rate_hz})),
      building_(building_of(structure, table, model, inputs, fine_step_s({rate_hz}))),
      rest_(building_->motion()),
      settle_s_(settle_time(structure, table, model.theta)),
      recent_(late.size(), kTaps),
      bias_share_(1 / (kBias_s * rate_hz)),
      filter_(
          std::vector<DerivativeTriple>(static_cast<std::size_t>(structure.degrees_of_freedom()),
                                        matched_triple(rate_hz)),
          HighPass(high_pass_hz, rate_hz)),
      unfiltered_(static_cast<std::size_t>(structure.degrees_of_freedom())) {
  bias_ = before_ = after_ = Eigen::VectorXd::Zero(late.size());
  for (const double of_input : late) taps_.push_back(taps(steps_, of_input));
  if (is_linear(model)) prepare_leap();
  restart();
}

/// Finds leap_ row by row, from the response to a unit of each entry.
void RunningModel::prepare_leap() {
  const auto motion = static_cast<Eigen::Index>(rest_.size()), inputs = before_.size();
  leap_.setZero(motion + inputs * (1 + kTaps), padded(static_cast<int>(motion)));
  from_.resize(static_cast<std::size_t>(leap_.rows()));
  to_.resize(static_cast<std::size_t>(leap_.cols()));
  for (Eigen::Index row = 0; row < leap_.rows(); ++row) {
    motion_ = rest_;
    before_.setZero();
    recent_.setZero();
    if (row < motion)
      motion_[static_cast<std::size_t>(row)] = 1;
    else if (row < motion + inputs)
      before_[row - motion] = 1;
    else
      recent_((row - motion) % inputs, (row - motion) / inputs - 1) = 1;
    (void)building_->resume(motion_);
    step_through();
    motion_ = building_->motion();
    std::copy(motion_.begin(), motion_.end(), leap_.row(row).begin());
  }
}

RunningModel::Taps RunningModel::taps(int steps, double late) {
  Taps out(steps, kTaps);
  // The step from kDelay + 1 instants ago to kDelay ago ends at these places between samples.
  for (int step = 0; step < steps; ++step) {
    const double end = static_cast<double>(step + 1) / steps + late;
    for (int age = 0; age < kTaps; ++age) {
      const double at = age - kDelay - 1 + end;
      const double window = std::abs(at) <= kDelay ? std::cos(M_PI * at / (2 * kDelay)) : 0;
      const double sinc = std::abs(at) < 1e-12 ? 1 : std::sin(M_PI * at) / (M_PI * at);
      out(step, age) = sinc * window * window;
    }
    out.row(step) /= out.row(step).sum();
  }
  return out;
}

void RunningModel::restart() {
  (void)building_->resume(rest_);
  motion_ = rest_;
  building_->set_time(kAfterEverything_s);
  recent_.setZero();
  before_.setZero();
  bias_.setZero();
  filter_.reset();
}

double RunningModel::remains(double time_s) const {
  return std::pow(kLeft, std::max(time_s, 0.0) / settle_s_);
}

void RunningModel::push(const Eigen::VectorXd& inputs) {
  bias_ += bias_share_ * (inputs - bias_);
  newest_ = newest_ == 0 ? kTaps - 1 : newest_ - 1;
  recent_.col(newest_) = inputs - bias_;
  if (leap_.rows() > 0)
    leap();
  else
    step_through();
  const Eigen::VectorXd& accel = building_->accel_abs();
  std::copy(accel.begin(), accel.end(), unfiltered_.begin());
  filter_.push(unfiltered_);
}

void RunningModel::step_through() {
  building_->set_time(kAfterEverything_s);
  for (int step = 0; step < steps_; ++step) {
    for (Eigen::Index i = 0; i < after_.size(); ++i) {
      double sum = 0;
      for (int age = 0; age < kTaps; ++age)
        sum += taps_[static_cast<std::size_t>(i)](step, age) * recent_(i, (newest_ + age) % kTaps);
      after_[i] = sum;
    }
    building_->drive(before_, after_);
    before_ = after_;
  }
}

void RunningModel::leap() {
  auto to = std::copy(motion_.begin(), motion_.end(), from_.begin());
  to = std::copy(before_.begin(), before_.end(), to);
  before_.setZero();
  for (int age = 0; age < kTaps; ++age) {
    const auto column = recent_.col((newest_ + age) % kTaps);
    to = std::copy(column.begin(), column.end(), to);
    for (Eigen::Index i = 0; i < before_.size(); ++i)
      before_[i] += taps_[static_cast<std::size_t>(i)](steps_ - 1, age) * column[i];
  }
  std::fill(to_.begin(), to_.end(), 0);
  kernels::in_use->multiply_add(from_.data(), static_cast<int>(from_.size()), 1,
                                static_cast<int>(from_.size()), leap_.data(), to_.data(),
                                static_cast<int>(to_.size()));
  std::copy(to_.begin(), to_.begin() + static_cast<std::ptrdiff_t>(motion_.size()),
            motion_.begin());
  (void)building_->resume(motion_);
}

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
