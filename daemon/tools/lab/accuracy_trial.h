// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/solve/batch_least_squares.h"
#include "estimator/pipeline/pipeline.h"
#include "estimator/simulate/ground_motion.h"

namespace framewatch::daemon {

/// Sampling rate of the accuracy trials.
inline constexpr double kTrialRate_hz = 100;
/// Distance of the trials' windows, s. They use few windows a second, so windows need not be solved
/// every hundredth of a second.
inline constexpr double kTrialHop_s = 0.25;
/// Seconds of a motion that the paper's batch least squares uses.
inline constexpr double kPaper_s = 10;
/// Two-sided 95 % point of Student's t with 19 degrees of freedom: batch means have 20 blocks.
inline constexpr double kStudent95 = 2.093;

/// Returns a seeded Kanai-Tajimi motion of 15 s at 45 degrees.
estimator::PlanMotion oblique_motion(std::uint64_t seed);

/// Exact motion of a building and the axes that measure it.
struct ExactRecord {
  std::vector<estimator::SensorAxis> axes;  ///< a sensor everywhere, noise densities set
  Eigen::MatrixXd accel_abs;                ///< instants x axes at kTrialRate_hz, m/s^2
};

/// Computes the motion from rest for duration_s. noise_ratio: white noise of every axis over the
/// rms of its motion.
ExactRecord exact_record(const estimator::Structure& structure, const Eigen::VectorXd& truth,
                         const estimator::PlanMotion& motion, double noise_ratio,
                         double duration_s);
/// Returns the record's accelerations with the axes' noise added.
Eigen::MatrixXd with_noise(const ExactRecord& record, std::uint64_t seed);

/// Returns the configuration that estimates a record. The design is off by up to `k_off` and
/// `other_off` (perturbed_design()).
estimator::PipelineConfig trial_config(const estimator::Structure& structure,
                                       const ExactRecord& record, const Eigen::VectorXd& truth,
                                       double k_off, double other_off, std::uint64_t seed);

/// Returns full windows of a pipeline for accelerations (instants x axes, the first at time 0). The
/// first window ends at from_s or later, the others follow every_s apart.
std::vector<estimator::WindowEstimate> run_windows(const estimator::PipelineConfig& config,
                                                   const Eigen::MatrixXd& accel, double from_s,
                                                   double every_s);

/// A window and the newest check of the model at its end; ModelFit::sequence -1: no check yet.
struct CheckedWindow {
  estimator::WindowEstimate estimate;
  estimator::ModelFit fit;
};
/// Does the same as run_windows(), with the checks of the model.
std::vector<CheckedWindow> run_checked_windows(const estimator::PipelineConfig& config,
                                               const Eigen::MatrixXd& accel, double from_s,
                                               double every_s);

/// A run of the whole pipeline on exact motion of a known building with noisy accelerometers.
struct AccuracyTrial {
  estimator::Structure structure;
  Eigen::VectorXd truth;   ///< theta order, SI
  Eigen::VectorXd design;  ///< given to the estimator
  estimator::PlanMotion motion;
  double duration_s = 15;
  double noise_ratio = 0;  ///< white noise of each axis over the rms of its motion
  std::uint64_t seed = 1;
  estimator::EstimatorOptions options;
  double every_s = 1;  ///< distance of the full windows that are returned
};

std::vector<estimator::WindowEstimate> run_trial(const AccuracyTrial& trial);

/// Returns the truth with every frame stiffness off by at most frame_stiffness_off and every other
/// parameter by at most other_off, relative, drawn uniformly by seed.
Eigen::VectorXd perturbed_design(const estimator::ParameterTable& table,
                                 const Eigen::VectorXd& truth, double frame_stiffness_off,
                                 double other_off, std::uint64_t seed);

/// Errors of one kind of parameter over windows and trials.
struct ErrorStatistics {
  std::vector<double> relative_error;  ///< |solution / truth - 1|, published or not
  int published = 0;
  int covered = 0;  ///< published with truth inside the 95 % interval

  double quantile(double probability) const;
  double published_ratio() const;
  double coverage_ratio() const;  ///< NaN when nothing was published
  void add(const ErrorStatistics& other);
};

/// By ParameterKind, of stories and groups; without bending.
using ErrorsByKind = std::array<ErrorStatistics, 4>;

/// Adds the errors of the windows to `errors`.
void collect_errors(const std::vector<estimator::WindowEstimate>& windows,
                    const estimator::ParameterTable& table, const Eigen::VectorXd& truth,
                    ErrorsByKind& errors);

/// Adds the noise of the paper's examples: every acceleration, velocity and displacement has
/// separate white noise between 0.075 and 150 rad/s, noise_ratio times its rms.
estimator::MotionHistory with_paper_noise(const estimator::MotionHistory& exact, double rate_hz,
                                          double noise_ratio, std::uint64_t seed);

/// Applies the paper's removal of noise to every channel (p = 200, q = 5, s(r) >= 0.98).
estimator::MotionHistory denoised(const estimator::MotionHistory& noisy);

}  // namespace framewatch::daemon
