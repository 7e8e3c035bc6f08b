#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/sensor_model.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// The effects of channels, on motion that the sensors then measure with their noise. They act in
/// the order of the list, time shifts and clipping apart: the first is a delay of the response
/// channel, the second a limit of the sensor.
class ChannelEffects {
 public:
  /// Those of other kinds are ignored; all must be without problems.
  explicit ChannelEffects(std::vector<Effect> effects);

  void delay(std::vector<ResponseChannel>& channels) const;
  void limit(std::vector<SensorModel>& models) const;
  /// What the axes give of the motion they sense, m/s^2, both in axis order.
  const Eigen::VectorXd& apply(double time_s, const Eigen::VectorXd& motion);

 private:
  std::vector<Effect> effects_;
  Eigen::VectorXd out_;
};

}  // namespace framewatch::estimator
