// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "estimator/numeric/nan.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/shaking/story_response.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The largest absolute values over a time; NaN: never known.
struct PeakResponse {
  static constexpr double kLately_s = 2;  ///< time constant of lately_mps2

  std::vector<double> accel_mps2;                  ///< of each axis
  std::vector<double> drift_m;                     ///< of each frame in each story (Structure::dof)
  std::array<double, 2> base_shear_n{kNaN, kNaN};  ///< along x and y
  /// StoryResponse::slow_m() at the peak of drift_m, with the peak's sign; NaN: not known.
  std::vector<double> slow_m;
  /// By frame in each story, then axis: largest acceleration of the axis while the drift was not
  /// known; NaN: the drift was always known. Before an interruption lately_mps2 counts.
  std::vector<double> unseen_mps2;
  std::vector<double> lately_mps2;  ///< of each axis, decaying

  PeakResponse() = default;
  PeakResponse(std::size_t axes, std::size_t degrees_of_freedom)
      : accel_mps2(axes, kNaN),
        drift_m(degrees_of_freedom, kNaN),
        slow_m(degrees_of_freedom, kNaN),
        unseen_mps2(axes * degrees_of_freedom, kNaN),
        lately_mps2(axes, 0),
        before_m_(3 * degrees_of_freedom, kNaN) {}
  void take(const StoryResponse& response);

  void archive(auto& a) {
    a(accel_mps2, drift_m, base_shear_n, slow_m, unseen_mps2, before_m_);
    a.each_within(lately_mps2, 0, a.kMax);
  }

 private:
  void take_drift(std::size_t dof, double drift, double slow);
  void note_unseen(std::size_t dof, const std::vector<double>& accel);

  /// By frame in each story: the drift two instants ago, one instant ago, and the slow part one
  /// instant ago.
  std::vector<double> before_m_;
};

/// Story drift over story height, of the frame that drifted most.
struct PeakDrift {
  double ratio = kNaN;
  int frame = -1;  ///< -1: no drift is known
};
/// Returns the peak drift of a story, counted from 1.
PeakDrift peak_drift(const PeakResponse& peak, const Structure& structure, int story);
/// Returns true if channels on a story's floor and on the one below measure its drift. Otherwise
/// the identified model computes the motion of floors without channels.
bool drift_is_measured(const PipelineConfig& config, int story);
/// Returns the largest drift ratio of all stories; 0 if none is known.
double largest_drift_ratio(const PeakResponse& peak, const Structure& structure);
/// Returns the peak acceleration of the axes at a level, 0: the base; NaN if it is not known.
double peak_accel_mps2(const PeakResponse& peak, const std::vector<SensorAxis>& axes, int level);

/// The peak drift of one story for an engineer. Ratios are over the story's height; errors are one
/// standard deviation. Permanent drift is not included: accelerations do not show it.
struct StoryDrift {
  int story = 0;              ///< from 1
  int frame = -1;             ///< the frame that drifted most; -1: no drift is known
  double ratio = kNaN;        ///< NaN: not known
  double std_error = kNaN;    ///< of `ratio`; NaN: not known
  double noise_error = kNaN;  ///< part from the sensors' noise
  double slow_error = kNaN;   ///< part from the motion below the integration's corner
  double model_error = 0;     ///< part from the model that computes floors without sensors
  double slow_ratio = kNaN;   ///< part of `ratio` restored by the identified stiffness
  bool measured = false;      ///< by channels on its floor and the one below
  double unseen_share = 0;    ///< see kUnseen
  /// The peak may lie in an interruption if a channel moved by more than this share of its peak
  /// while the drift was not known.
  static constexpr double kUnseen = 0.5;
  bool interrupted_at_peak() const { return unseen_share >= kUnseen; }
  bool known() const { return frame >= 0; }
};

/// Returns the variance of a displacement, m^2, per variance of white noise in the acceleration's
/// samples, (m/s^2)^2: the energy of the impulse response of StoryResponse. docs/equations.md (60).
double displacement_noise_gain(const EstimatorOptions& options);

/// Returns the drift of every story, from the lowest up. config: with the axes of `peak`. known:
/// stiffness and noise at the end of the motion. docs/equations.md (60) to (62).
std::vector<StoryDrift> story_drifts(const PipelineConfig& config, const PeakResponse& peak,
                                     const DriftKnowledge& known);

}  // namespace framewatch::estimator
