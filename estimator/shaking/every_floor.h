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

  /// Precondition: config.parameters().grouped(). settling: instants that the motion by new
  /// stiffnesses goes on beside the old one after its own start is forgotten.
  EveryFloor(const PipelineConfig& config, std::int64_t settling);

  /// FloorMotion::push(); also NaN until the start is forgotten after a channel went or came back.
  const Eigen::VectorXd& push(const SampleSet& set);
  /// The motion by stiffnesses that take the place of those in use later, likewise; null: none.
  const Eigen::VectorXd* coming() const { return coming_in_ > 0 ? &coming_accel_ : nullptr; }
  bool began() const { return began_; }      ///< coming() is there since the last push()
  bool swapped() const { return swapped_; }  ///< its motion took over at the last push()
  /// Stiffnesses that differ from those in use by more than kFar are taken over. The motion goes on
  /// by those in use until the start of the new ones is forgotten, so that no peak is missed.
  /// Bounded in time by one FloorMotion::tune().
  void follow(const WindowEstimate& estimate);

  template <typename Archive>
  void archive(Archive& a) {
    a(motion_, coming_);
    a.within(unsettled_, 0, Archive::kMaxCount);
    for (std::int64_t* count : {&coming_in_, &coming_unsettled_})
      a.within(*count, 0, Archive::kMaxCount);
    a.each_within(away_, 0, Archive::kMaxCount);
  }

 private:
  bool follow_channels(const SampleSet& set);
  void push_coming(const SampleSet& set);

  FloorMotion motion_;
  FloorMotion coming_;  ///< takes the place of motion_ in coming_in_ instants
  std::int64_t settling_;
  std::int64_t coming_in_ = 0, coming_unsettled_ = 0;  ///< coming_in_ 0: none is coming
  Eigen::VectorXd coming_accel_;
  bool began_ = false, swapped_ = false;
  std::size_t elements_;
  std::vector<std::uint8_t> used_;  ///< axes that are not for a check
  double away_rows_;
  std::vector<double> away_;  ///< instants without a value, by axis
  std::int64_t unsettled_ = 0;
  Eigen::VectorXd unknown_;
};

}  // namespace framewatch::estimator
