#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "daemon/config.h"
#include "estimator/simulate/channel_effects.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/sensor_model.h"
#include "estimator/structure/effect.h"

namespace framewatch::daemon {

/// A virtual test: the building and its sensors as configured, what it really is, how the ground
/// moves, what breaks.
struct Scenario {
  Config config;
  Eigen::VectorXd truth;  ///< table order, SI
  PlanMotion motion;
  std::vector<ParameterChange> changes;
  std::vector<Effect> effects;       ///< those of config and the scenario's own
  std::vector<SensorModel> sensors;  ///< parallel to config.pipeline.axes
  std::vector<double> noise_ratio;   ///< of the axis' rms over the test, beside sensors' density
  double rate_hz = 100;
  double duration_s = 0;
  std::uint64_t seed = 1;
};

/// Instants of a scenario, from time 0, as its sensors give them.
class Simulation {
 public:
  explicit Simulation(const Scenario& scenario);

  /// Raw values in axis order, NaN where lost.
  const std::vector<double>& next();
  /// Whether what next() gave last is no motion of a building: a softening law has run away.
  bool collapsed() const { return collapsed_; }
  /// Of the instant next() gave last, s.
  double time_s() const { return response_.time_s(); }

 private:
  ResponseStream response_;
  ChannelEffects channel_effects_;
  SensorArray sensors_;
  bool collapsed_ = false;
};

/// Instants in the scenario's duration, both ends included.
std::int64_t instants(const Scenario& scenario);

}  // namespace framewatch::daemon
