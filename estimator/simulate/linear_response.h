#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "estimator/simulate/decimator.h"
#include "estimator/simulate/ground_motion.h"
#include "estimator/simulate/simulated_building.h"
#include "estimator/structure/effect.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

struct ResponseOptions {
  double rate_hz = 100;
  double longest_step_s = 1e-3;  ///< the fine step is the largest one below that divides 1/rate
  bool anti_alias = true;        ///< before decimation, on every channel alike, without delay
};

/// Parameters that hold from a time on.
struct ParameterChange {
  double at_s;
  Eigen::VectorXd theta;
};

/// What a stream gives: a degree of freedom, or after the last one base x and base y, then the
/// forces from outside on every degree of freedom, as it was delay_s before the instant.
struct ResponseChannel {
  int column;
  double delay_s = 0;  ///< only 0 without the anti-alias filter, which makes it
  double weight = 1;   ///< of the column
  std::vector<std::pair<int, double>> also = {};  ///< further columns with their weights
};

/// Of the integration, s.
double fine_step_s(const ResponseOptions& options);

/// The response of a building, one output instant after the other. The ground motion is taken at
/// the fine steps and linear between them; a linear building's response to it is exact. Not the
/// estimator's scheme, on purpose.
class ResponseStream {
 public:
  /// Changes in ascending order of time; each acts from the first fine step at or after its time.
  /// No channels: every degree of freedom (Structure::dof), base x and base y, without delay.
  ResponseStream(const Structure& structure, const ParameterTable& table,
                 const Eigen::VectorXd& theta, PlanMotion motion, ResponseOptions options,
                 std::vector<ParameterChange> changes = {},
                 const std::vector<ResponseChannel>& channels = {},
                 const std::vector<Effect>& effects = {});
  /// Of any building at rest whose step is fine_step_s(options).
  ResponseStream(std::unique_ptr<SimulatedBuilding> building, PlanMotion motion,
                 ResponseOptions options, std::vector<ParameterChange> changes,
                 const std::vector<ResponseChannel>& channels);

  /// Absolute accelerations of the channels, m/s^2, or forces, N, at the next instant, the first
  /// being time 0.
  /// After the motion's end the ground rests.
  const Eigen::VectorXd& next();
  /// Of the instant next() gave last, s.
  double time_s() const;

 private:
  void advance();
  Eigen::Vector2d ground(long long step) const;

  PlanMotion motion_;
  ResponseOptions options_;
  std::vector<ParameterChange> changes_;
  int ratio_;  ///< fine steps per output instant
  std::unique_ptr<SimulatedBuilding> building_;
  Decimator decimator_;
  std::size_t next_change_ = 0;
  long long step_;          ///< fine step the building stands at
  long long instant_ = -1;  ///< output instant given last
  Eigen::VectorXd fine_;
};

/// Sampled response: accel_abs is instants x (degrees of freedom, base x, base y), m/s^2.
struct Response {
  double rate_hz;
  Eigen::MatrixXd accel_abs;
};

/// From rest, from time 0 for duration_s (the motion's when negative), both ends included.
Response linear_response(const Structure& structure, const ParameterTable& table,
                         const Eigen::VectorXd& theta, const PlanMotion& motion,
                         const ResponseOptions& options = {}, double duration_s = -1);

}  // namespace framewatch::estimator
