// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "daemon/config/config.h"
#include "tests/support/restless_building.h"

namespace framewatch::soak {

/// The messages of all nodes at one instant.
struct Instant {
  std::int64_t time_us;              ///< by the nodes' clock
  const std::vector<double>* accel;  ///< per axis, m/s^2; NaN: its node sends nothing
};

/// An undamaged building for any duration: quiet, busier by day, with traffic, two earthquakes and
/// stiffness that follows a daily temperature. One sensor fails for a while, one is stuck, one has
/// spikes, and the nodes' clock steps three times. Times of these events are shares of the
/// duration.
class SoakNight {
 public:
  static constexpr double kSwing = 0.03;  ///< of stiffness in a day, trough to crest
  static constexpr int kClockSteps = 3;

  SoakNight(const estimator::PipelineConfig& config, std::int64_t instants, std::uint64_t seed);

  Instant next();
  /// At the last instant that next() returned.
  double degc() const { return degc_; }

 private:
  double share(double of) const { return of * static_cast<double>(instants_); }
  bool within(double from, double to) const {
    return static_cast<double>(at_) >= share(from) && static_cast<double>(at_) < share(to);
  }
  void season();
  void fail(std::vector<double>& accel);

  std::int64_t instants_, at_ = -1, clock_us_ = 0, burst_ = 0;
  Eigen::VectorXd truth_;
  int parameters_stiff_;  ///< number of stiffnesses, the first half of theta
  estimator::Random random_;
  test::RestlessBuilding building_;
  double degc_ = 10;
  std::vector<double> accel_;
};

}  // namespace framewatch::soak
