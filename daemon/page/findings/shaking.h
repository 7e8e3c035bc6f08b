// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

#include "estimator/motion/sample_merger.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/shaking/story_drift.h"
#include "estimator/shaking/story_response.h"

namespace framewatch::daemon {

/// The response of the building from its first to its last motion above a threshold.
struct Shake {
  std::int64_t from_us = 0, to_us = 0;  ///< sensor time
  bool over = false;
  estimator::PeakResponse peak;
};

/// Follows the calibrated motion and keeps the peaks of the newest and of the strongest shake. A
/// shake is any motion above the noise; estimator::ShakingWatch looks for strong motion only. Uses
/// sensor time and a fixed amount of memory.
class Shaking {
 public:
  static constexpr double kMoves_mps2 = 0.05;  ///< least threshold; higher with noisy sensors
  static constexpr double kCalm_s = 10;        ///< without motion: ends the shake

  /// Precondition: problems(config) is empty. `config` must outlive this.
  explicit Shaking(const estimator::PipelineConfig& config);

  void push(const estimator::SampleSet& instant);
  /// Takes an estimate, which determines the motion of floors without sensors from now on.
  void follow(const estimator::WindowEstimate& estimate) { response_.follow(estimate); }

  /// Returns the motion at the last instant.
  const estimator::StoryResponse& response() const { return response_; }
  /// Returns the drifts of the newest shake with their errors; empty before the first shake. Cached
  /// until the shake continues.
  const std::vector<estimator::StoryDrift>& drifts() const;
  /// Returns nullptr before the first shake.
  const Shake* newest() const { return newest_ ? &*newest_ : nullptr; }
  /// Returns the shake with the largest drift ratio; nullptr before the first.
  const Shake* strongest() const;
  std::int64_t first_us() const { return first_us_; }  ///< time of the first instant; 0: none yet

 private:
  bool moves() const;
  double drift_ratio(const Shake& shake) const;

  const estimator::PipelineConfig& config_;
  double threshold_mps2_;
  estimator::StoryResponse response_;
  std::int64_t first_us_ = 0;
  std::optional<Shake> newest_, strongest_;
  mutable std::vector<estimator::StoryDrift> drifts_;
  mutable std::int64_t drifts_until_us_ = 0;  ///< Shake::to_us when drifts_ was computed
};

}  // namespace framewatch::daemon
