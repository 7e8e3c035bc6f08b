// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "estimator/setup/pipeline_config.h"
#include "estimator/simulate/decimator.h"
#include "estimator/simulate/random.h"

namespace framewatch::test {

/// The 20-story building of daemon/tools/lab/few_sensors.h with sensors on every fifth floor, whose
/// stories soften while they move and recover: k = k0 (1 - softening A / (A + usual)), A each
/// story's running rms drift, which rises within kRise_s and falls within kFall_s. Central
/// differences at 1 ms, another scheme than the estimator's and the linear simulation's. Groups of
/// stories are off their design by up to 20 %, stories within them by 5 % and masses by 2 %,
/// standard deviations.
class SofteningTower {
 public:
  static constexpr int kStories = 20;
  static constexpr double kRate_hz = 100, kRise_s = 2, kFall_s = 20;

  /// softening: loss of stiffness at very large motion, relative; 0: none. noise_ratio: of every
  /// channel, over the rms of its motion under shaking of level 1.
  SofteningTower(std::uint64_t seed, double softening, double noise_ratio);

  const estimator::PipelineConfig& config() const { return config_; }
  /// Sets new stiffnesses; the motion continues.
  void lose(int story, double ratio) { stiffness_[story - 1] *= 1 - ratio; }
  /// Returns the stiffness of stories `first` to `last` in series, without softening, N/m.
  double stiffness(int first, int last) const {
    return 1 / stiffness_.segment(first - 1, last - first + 1).inverse().sum();
  }
  /// Returns the channels' measurements at the next instant, m/s^2. level: of the ground's motion;
  /// 1: strong.
  const Eigen::VectorXd& next(double level);

 private:
  void step(double level);
  void measure_noise();

  estimator::PipelineConfig config_;
  estimator::Random random_;
  Eigen::ArrayXd mass_, stiffness_, damping_;
  double softening_;
  Eigen::ArrayXd moved_, velocity_, level_, usual_;  ///< of floors; of stories
  double ground_moved_ = 0, ground_velocity_ = 0;
  Eigen::VectorXd fine_, sigma_, out_;
  std::unique_ptr<estimator::Decimator> decimator_;
};

}  // namespace framewatch::test
