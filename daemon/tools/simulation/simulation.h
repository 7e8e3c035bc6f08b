#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/config/config.h"
#include "estimator/simulate/channel_effects.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/sensor_model.h"
#include "estimator/structure/effect.h"

namespace framewatch::daemon {

/// Why a scenario is too long or its building too large to be simulated; empty when it is not.
/// Reckoned before anything of that size is made.
std::string size_problem(const Scenario& scenario);

/// A virtual test: the building and sensors as configured, the true parameters, the ground motion,
/// and the changes.
struct Scenario {
  Config config;
  Eigen::VectorXd truth;  ///< table order, SI
  estimator::PlanMotion motion;
  std::vector<estimator::ParameterChange> changes;
  std::vector<estimator::Effect> effects;       ///< those of config and the scenario's own
  std::vector<estimator::SensorModel> sensors;  ///< parallel to config.pipeline.axes
  std::vector<double> noise_ratio;  ///< of the axis' rms over the test, beside sensors' density
  double rate_hz = 100;
  double duration_s = 0;
  std::uint64_t seed = 1;
};

/// Computes what the sensors of a scenario measure, instant after instant from time 0.
class Simulation {
 public:
  explicit Simulation(const Scenario& scenario);

  /// Raw values in axis order, NaN where lost.
  const std::vector<double>& next();
  /// Returns true if the last motion of next() has diverged, which a softening law can cause.
  bool collapsed() const { return collapsed_; }
  /// Time of the instant that next() returned last, s.
  double time_s() const { return response_.time_s(); }

 private:
  estimator::ResponseStream response_;
  estimator::ChannelEffects channel_effects_;
  estimator::SensorArray sensors_;
  bool collapsed_ = false;
};

/// Instants in the scenario's duration, both ends included.
std::int64_t instants(const Scenario& scenario);

}  // namespace framewatch::daemon
