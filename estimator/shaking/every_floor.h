#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/identify/groups/floor_motion.h"
#include "estimator/motion/sample.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// FloorMotion of a building that is watched: by the parameters that were last identified, and by
/// the channels that have values.
class EveryFloor {
 public:
  static constexpr double kFar = 0.1;   ///< relative change of a stiffness that is followed
  static constexpr double kAway_s = 2;  ///< a channel without values is done without after it

  /// Precondition: config.parameters().grouped().
  explicit EveryFloor(const PipelineConfig& config);

  /// FloorMotion::push(); also NaN until the start is forgotten after follow() changed something.
  const Eigen::VectorXd& push(const SampleSet& set);
  /// Stiffnesses that differ from those in use by more than kFar are taken over. Bounded in time by
  /// one FloorMotion::tune().
  void follow(const WindowEstimate& estimate);

  template <typename Archive>
  void archive(Archive& a) {
    a(motion_);
    a.within(unsettled_, 0, Archive::kMostCount);
    a.each_within(away_, 0, Archive::kMostCount);
  }

 private:
  bool follow_channels(const SampleSet& set);

  FloorMotion motion_;
  std::size_t elements_;
  std::vector<std::uint8_t> used_;  ///< axes that are not for a check
  double away_rows_;
  std::vector<double> away_;  ///< instants without a value, by axis
  std::int64_t unsettled_ = 0;
  Eigen::VectorXd unknown_;
};

}  // namespace framewatch::estimator
