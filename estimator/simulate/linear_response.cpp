// SPDX-License-Identifier: MIT
#include "estimator/simulate/linear_response.h"

#include <cassert>
#include <cmath>
#include <utility>

#include "estimator/simulate/linear_building.h"
#include "estimator/simulate/nonlinear_building.h"

namespace framewatch::estimator {
namespace {

/// Times are multiples of a binary-inexact step.
constexpr double kRounding_s = 1e-9;

/// Returns the number of degrees of freedom, plus 2 for the base, plus one force for each degree if
/// there are forces.
Eigen::Index columns_of(const SimulatedBuilding& building) {
  return building.accel_abs().size() + 2 + building.applied_n().size();
}

Decimator decimator(const std::vector<ResponseChannel>& wanted, const ResponseOptions& options,
                    int ratio, const SimulatedBuilding& building) {
  const auto columns = static_cast<int>(columns_of(building));
  std::vector<DecimatorChannel> channels;
  const auto add = [&](const ResponseChannel& c) {
    assert(options.anti_alias || c.delay_s == 0);
    const bool exists = c.column < columns;  // false for a force that nothing applies
    channels.push_back({exists ? c.column : 0,
                        options.anti_alias
                            ? anti_alias_taps(ratio, c.delay_s * options.rate_hz * ratio)
                            : std::vector<double>{1.0},
                        exists ? c.weight : 0, exists ? c.also : decltype(c.also){}});
  };
  for (const ResponseChannel& c : wanted) add(c);
  if (wanted.empty())
    for (int column = 0; column < building.accel_abs().size() + 2; ++column) add({column});
  return {std::move(channels), columns};
}

std::unique_ptr<SimulatedBuilding> make_building(const Structure& structure,
                                                 const ParameterTable& table,
                                                 const Eigen::VectorXd& theta,
                                                 const std::vector<Effect>& effects,
                                                 double step_s) {
  if (concerns_building(effects))
    return std::make_unique<NonlinearBuilding>(structure, table, theta, effects, step_s);
  return std::make_unique<LinearBuilding>(structure, table, theta, step_s);
}

}  // namespace

int steps_per_instant(const ResponseOptions& options) {
  return static_cast<int>(std::ceil(1 / (options.rate_hz * options.longest_step_s) - 1e-9));
}

double fine_step_s(const ResponseOptions& options) {
  return 1 / (options.rate_hz * steps_per_instant(options));
}

ResponseStream::ResponseStream(const Structure& structure, const ParameterTable& table,
                               const Eigen::VectorXd& theta, PlanMotion motion,
                               ResponseOptions options, std::vector<ParameterChange> changes,
                               const std::vector<ResponseChannel>& channels,
                               const std::vector<Effect>& effects)
    : ResponseStream(make_building(structure, table, theta, effects, fine_step_s(options)),
                     std::move(motion), options, std::move(changes), channels) {}

ResponseStream::ResponseStream(std::unique_ptr<SimulatedBuilding> building, PlanMotion motion,
                               ResponseOptions options, std::vector<ParameterChange> changes,
                               const std::vector<ResponseChannel>& channels)
    : motion_(std::move(motion)),
      options_(options),
      changes_(std::move(changes)),
      ratio_(steps_per_instant(options)),
      building_(std::move(building)),
      decimator_(decimator(channels, options, ratio_, *building_)),
      step_(-decimator_.delay_steps() - 1),
      fine_(Eigen::VectorXd::Zero(columns_of(*building_))) {
  building_->set_time(static_cast<double>(step_) * fine_step_s(options));
}

const Eigen::VectorXd& ResponseStream::next() {
  ++instant_;
  while (step_ < instant_ * ratio_ + decimator_.delay_steps()) advance();
  return decimator_.output();
}

double ResponseStream::time_s() const {
  return static_cast<double>(instant_) / options_.rate_hz;
}

Eigen::Vector2d ResponseStream::ground(long long step) const {
  const double t = static_cast<double>(step) / (options_.rate_hz * ratio_);
  return {motion_.x.at(t), motion_.y.at(t)};
}

void ResponseStream::advance() {
  const double now_s = static_cast<double>(step_) / (options_.rate_hz * ratio_);
  while (next_change_ < changes_.size() && changes_[next_change_].at_s <= now_s + kRounding_s)
    building_->set_theta(changes_[next_change_++].theta);
  const Eigen::Index dofs = building_->accel_abs().size();
  const Eigen::Vector2d before = fine_.segment<2>(dofs), after = ground(++step_);
  building_->advance(before, after);
  fine_.head(dofs) = building_->accel_abs();
  fine_.segment<2>(dofs) = after;
  if (building_->applied_n().size() > 0) fine_.tail(dofs) = building_->applied_n();
  decimator_.push(fine_);
}

Response linear_response(const Structure& structure, const ParameterTable& table,
                         const Eigen::VectorXd& theta, const PlanMotion& motion,
                         const ResponseOptions& options, double duration_s) {
  if (duration_s < 0) duration_s = motion.duration_s();
  const auto instants =
      static_cast<Eigen::Index>(std::floor(duration_s * options.rate_hz + 1e-6)) + 1;
  Response out{options.rate_hz, Eigen::MatrixXd(instants, structure.degrees_of_freedom() + 2)};
  ResponseStream stream(structure, table, theta, motion, options);
  for (Eigen::Index i = 0; i < instants; ++i) out.accel_abs.row(i) = stream.next().transpose();
  return out;
}

MotionHistory exact_motion(const Structure& structure, const ParameterTable& table,
                           const Eigen::VectorXd& theta, const PlanMotion& motion, double rate_hz,
                           Eigen::Index rows) {
  const int ratio = steps_per_instant({rate_hz});
  const double step_s = fine_step_s({rate_hz});
  const auto ground = [&](Eigen::Index step) {
    const double t = static_cast<double>(step) * step_s;
    return Eigen::Vector2d(motion.x.at(t), motion.y.at(t));
  };
  LinearBuilding building(structure, table, theta, step_s);
  const Eigen::Index columns = structure.degrees_of_freedom();
  MotionHistory out{Eigen::MatrixXd(rows, columns), Eigen::MatrixXd(rows, columns),
                    Eigen::MatrixXd(rows, columns)};
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index k = (i - 1) * ratio; i > 0 && k < i * ratio; ++k)
      building.advance(ground(k), ground(k + 1));
    out.accel_abs.row(i) = building.accel_abs().transpose();
    out.vel_rel.row(i) = building.vel_rel().transpose();
    out.disp_rel.row(i) = building.disp_rel().transpose();
  }
  return out;
}

}  // namespace framewatch::estimator
