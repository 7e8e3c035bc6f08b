// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/solve/batch_least_squares.h"
#include "estimator/simulate/decimator.h"
#include "estimator/simulate/ground_motion.h"
#include "estimator/simulate/simulated_building.h"
#include "estimator/structure/effect.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

struct ResponseOptions {
  double rate_hz = 100;
  double longest_step_s =
      1e-3;                ///< the fine step is the largest one up to this that divides 1/rate
  bool anti_alias = true;  ///< filter every channel before decimation, without delay
};

/// Parameters that hold from a time on.
struct ParameterChange {
  double at_s;
  Eigen::VectorXd theta;
};

/// An output of a stream: a degree of freedom, then base x and base y, then the external forces on
/// every degree of freedom, delay_s before the instant.
struct ResponseChannel {
  int column;
  double delay_s = 0;  ///< must be 0 without the anti-alias filter, which makes the delay
  double weight = 1;   ///< of the column
  std::vector<std::pair<int, double>> also = {};  ///< further columns with their weights
};

/// Return the number of integration steps from one instant to the next, and their length, s.
int steps_per_instant(const ResponseOptions& options);
double fine_step_s(const ResponseOptions& options);

/// Computes the response of a building, one output instant after the other. The ground motion is
/// sampled at the fine steps and linear between them; a linear building's response to it is exact.
/// The scheme deliberately differs from the estimator's.
class ResponseStream {
 public:
  /// changes: in ascending order of time; each acts from the first fine step at or after its time.
  /// channels: empty for every degree of freedom (Structure::dof), base x and base y, without
  /// delay.
  ResponseStream(const Structure& structure, const ParameterTable& table,
                 const Eigen::VectorXd& theta, PlanMotion motion, ResponseOptions options,
                 std::vector<ParameterChange> changes = {},
                 const std::vector<ResponseChannel>& channels = {},
                 const std::vector<Effect>& effects = {});
  /// building: at rest, with a step of fine_step_s(options).
  ResponseStream(std::unique_ptr<SimulatedBuilding> building, PlanMotion motion,
                 ResponseOptions options, std::vector<ParameterChange> changes,
                 const std::vector<ResponseChannel>& channels);

  /// Returns the channels' absolute accelerations, m/s^2, or forces, N, at the next instant; the
  /// first is at time 0. After the motion's end the ground rests.
  const Eigen::VectorXd& next();
  /// Returns the time of the last instant, s.
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
  long long step_;          ///< fine step of the building's state
  long long instant_ = -1;  ///< last output instant
  Eigen::VectorXd fine_;
};

/// Sampled response: accel_abs is instants x (degrees of freedom, base x, base y), m/s^2.
struct Response {
  double rate_hz;
  Eigen::MatrixXd accel_abs;
};

/// Returns the response from rest, from time 0 for duration_s (the motion's when negative), both
/// ends included.
Response linear_response(const Structure& structure, const ParameterTable& table,
                         const Eigen::VectorXd& theta, const PlanMotion& motion,
                         const ResponseOptions& options = {}, double duration_s = -1);

/// Returns the exact response from rest, `rows` instants from time 0. Without an anti-alias filter
/// the equation of motion holds at every instant. The ground motion is linear within steps of at
/// most 1 ms.
MotionHistory exact_motion(const Structure& structure, const ParameterTable& table,
                           const Eigen::VectorXd& theta, const PlanMotion& motion, double rate_hz,
                           Eigen::Index rows);

}  // namespace framewatch::estimator
