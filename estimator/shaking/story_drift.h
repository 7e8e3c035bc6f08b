#pragma once

#include <vector>

#include "estimator/numeric/nan.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/shaking/slow_drift.h"
#include "estimator/shaking/story_response.h"

namespace framewatch::estimator {

/// The peak drift of one story as an engineer needs it. Ratios are over the story's height, errors
/// one standard deviation. Permanent drift is in none of them: accelerations do not show it.
struct StoryDrift {
  int story = 0;              ///< from 1
  int frame = -1;             ///< the frame that drifted most; -1: of none it is known
  double ratio = kNaN;        ///< NaN: not known
  double std_error = kNaN;    ///< of `ratio`; NaN: not known
  double noise_error = kNaN;  ///< its part from the sensors' noise
  double slow_error = kNaN;   ///< its part from what the integration's corner removes
  double model_error = 0;     ///< its part from the model that computes floors without sensors
  double slow_ratio = kNaN;   ///< part of `ratio` that the identified stiffness restored
  bool measured = false;      ///< by channels on its floor and on the one below
  double unseen_share = 0;    ///< see kGap
  /// True when the peak may lie in a gap: while the drift was not known, a channel moved by more
  /// than this share of its own peak.
  static constexpr double kGap = 0.5;
  bool gap_at_peak() const { return unseen_share >= kGap; }
  bool known() const { return frame >= 0; }
};

/// Variance of a displacement, m^2, per variance of white noise in the acceleration's samples,
/// (m/s^2)^2: the energy of the impulse response of StoryResponse. docs/equations.md (60).
double displacement_noise_gain(const EstimatorOptions& options);

/// Every story, from the lowest up. config: with the axes that `peak` is of; known: what the
/// stiffness and the noise were at the end of the motion. docs/equations.md (60) to (62).
std::vector<StoryDrift> story_drifts(const PipelineConfig& config, const PeakResponse& peak,
                                     const DriftKnowledge& known);

}  // namespace framewatch::estimator
