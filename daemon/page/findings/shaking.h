#pragma once

#include <cstdint>
#include <optional>

#include "estimator/motion/sample_merger.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/shaking/story_drift.h"
#include "estimator/shaking/story_response.h"

namespace framewatch::daemon {

/// What the building went through from its first to its last motion above a threshold.
struct Shake {
  std::int64_t from_us = 0, to_us = 0;  ///< sensor time
  bool over = false;
  estimator::PeakResponse peak;
};

/// Follows the calibrated motion and keeps the peaks of the newest shake and of the strongest one:
/// any motion that can be told from noise, where estimator::ShakingWatch waits for strong motion.
/// Sensor time only; a fixed amount of memory.
class Shaking {
 public:
  static constexpr double kMoves_mps2 = 0.05;  ///< less is no shaking; nor is what noise can be
  static constexpr double kCalm_s = 10;        ///< without motion: the shake is over

  /// Precondition: problems(config) is empty. `config` must outlive this.
  explicit Shaking(const estimator::PipelineConfig& config);

  void push(const estimator::SampleSet& instant);
  /// What was identified: floors without sensors move by it from now on.
  void follow(const estimator::WindowEstimate& estimate) { response_.follow(estimate); }

  /// The motion at the last instant.
  const estimator::StoryResponse& response() const { return response_; }
  /// Of the newest shake, with their errors; empty while there was none. Computed anew only when
  /// the shake has gone on since the last call.
  const std::vector<estimator::StoryDrift>& drifts() const;
  /// Null while there was none.
  const Shake* newest() const { return newest_ ? &*newest_ : nullptr; }
  /// By drift ratio, the newest one included.
  const Shake* strongest() const;
  std::int64_t first_us() const { return first_us_; }  ///< since when it is followed; 0: not yet

 private:
  bool moves() const;
  double drift_ratio(const Shake& shake) const;

  const estimator::PipelineConfig& config_;
  double threshold_mps2_;
  estimator::StoryResponse response_;
  std::int64_t first_us_ = 0;
  std::optional<Shake> newest_, strongest_;
  mutable std::vector<estimator::StoryDrift> drifts_;
  mutable std::int64_t drifts_until_us_ = 0;  ///< Shake::to_us that drifts_ are of
};

}  // namespace framewatch::daemon
