// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/config/config.h"
#include "estimator/simulate/climate.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/sensor_model.h"
#include "estimator/structure/effect.h"

namespace framewatch::daemon {

/// [climate]: the weather of a simulated building.
struct ClimateSettings {
  estimator::Climate climate;
  std::int64_t start_us = 0;         ///< UTC at the scenario's time 0
  double stiffness_error_ratio = 0;  ///< deviation of a window's value, relative
  double damping_error_ratio = 0;
};

/// A virtual test: configured building and sensors, true parameters, ground motion and changes.
struct Scenario {
  Config config;
  Eigen::VectorXd truth;  ///< table order, SI
  estimator::PlanMotion motion;
  std::vector<estimator::ParameterChange> changes;
  std::optional<ClimateSettings> climate;
  std::vector<estimator::Effect> effects;       ///< effects of config and of the scenario
  std::vector<estimator::SensorModel> sensors;  ///< parallel to config.pipeline.axes
  std::vector<double> noise_ratio;  ///< noise relative to the axis' rms, in addition to `sensors`
  double rate_hz = 100;
  double duration_s = 0;
  std::uint64_t seed = 1;
};

/// Computes the measurements of a scenario's sensors, instant by instant from time 0.
class Simulation {
 public:
  explicit Simulation(const Scenario& scenario);

  /// Returns the raw values in axis order, NaN for lost samples.
  const std::vector<double>& next();
  /// Returns true if the last motion of next() has diverged, which a softening law can cause.
  bool collapsed() const { return collapsed_; }
  /// Returns the time of the last instant of next(), s.
  double time_s() const { return response_.time_s(); }

 private:
  estimator::ResponseStream response_;
  estimator::ChannelEffects channel_effects_;
  estimator::SensorArray sensors_;
  std::vector<double> warmer_degc_;  ///< than the mean of the climate, by hour; empty: no climate
  bool collapsed_ = false;
};

/// Returns the true parameters from `time_s` on, in the mean climate: those of the newest change.
const Eigen::VectorXd& truth_at(const Scenario& scenario, double time_s);
/// Returns parameters in the newest hour of a climate. theta: in the mean climate.
Eigen::VectorXd weathered(const Eigen::VectorXd& theta, const estimator::ClimateStream& climate);
/// Returns the climate of a scenario from its time 0 on. Precondition: it has one.
estimator::ClimateStream climate_of(const Scenario& scenario);

/// Returns the number of instants in the scenario's duration, both ends included.
std::int64_t instants(const Scenario& scenario);

/// Returns the number of hours in a scenario's duration, at least 1.
std::int64_t hours(const Scenario& scenario);

/// Returns why a scenario is too long or its building too large to simulate, or an empty text.
/// Checks before allocating anything that large.
std::string size_problem(const Scenario& scenario);

}  // namespace framewatch::daemon
