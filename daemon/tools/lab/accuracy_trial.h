#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/pipeline/pipeline.h"
#include "estimator/simulate/ground_motion.h"

namespace framewatch::daemon {

/// Sampling rate of the accuracy trials.
inline constexpr double kTrialRate_hz = 100;
/// What the paper's batch least squares takes of a motion.
inline constexpr double kPaper_s = 10;
/// Two-sided 95 % point of Student's t with 19 degrees of freedom: batch means have 20 blocks.
inline constexpr double kStudent95 = 2.093;

/// A seeded Kanai-Tajimi motion of 15 s at 45 degrees.
estimator::PlanMotion oblique_motion(std::uint64_t seed);

/// Exact motion of a building and the axes that measure it.
struct ExactRecord {
  std::vector<estimator::SensorAxis> axes;  ///< a sensor everywhere, noise densities set
  Eigen::MatrixXd accel_abs;                ///< instants x axes at kTrialRate_hz, m/s^2
};

/// From rest, for duration_s; white noise of every axis: noise_ratio times the rms of its motion.
ExactRecord exact_record(const estimator::Structure& structure, const Eigen::VectorXd& truth,
                         const estimator::PlanMotion& motion, double noise_ratio,
                         double duration_s);
/// The record with the axes' noise on it.
Eigen::MatrixXd with_noise(const ExactRecord& record, std::uint64_t seed);

/// The full windows that a pipeline gives for accelerations (instants x axes, the first at time 0),
/// the first to end at from_s or later, the others every_s apart.
std::vector<estimator::WindowEstimate> run_windows(const estimator::PipelineConfig& config,
                                                   const Eigen::MatrixXd& accel, double from_s,
                                                   double every_s);

/// A window and the newest look at the model when it ended; ModelFit::sequence -1: none yet.
struct CheckedWindow {
  estimator::WindowEstimate estimate;
  estimator::ModelFit fit;
};
/// As run_windows().
std::vector<CheckedWindow> run_checked_windows(const estimator::PipelineConfig& config,
                                               const Eigen::MatrixXd& accel, double from_s,
                                               double every_s);

/// One run of the whole pipeline on exact motion of a known building with noisy accelerometers.
struct AccuracyTrial {
  estimator::Structure structure;
  Eigen::VectorXd truth;   ///< theta order, SI
  Eigen::VectorXd design;  ///< what the estimator is told
  estimator::PlanMotion motion;
  double duration_s = 15;
  double noise_ratio = 0;  ///< white noise of each axis over the rms of its motion
  std::uint64_t seed = 1;
  estimator::EstimatorOptions options;
  double every_s = 1;  ///< full windows are kept at this distance
};

std::vector<estimator::WindowEstimate> run_trial(const AccuracyTrial& trial);

/// truth with every frame stiffness off by at most frame_stiffness_off and every other parameter by
/// at most other_off, relative, uniformly drawn by seed.
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

/// By ParameterKind, of stories and groups; bending is left out.
using ErrorsByKind = std::array<ErrorStatistics, 4>;

void collect_errors(const std::vector<estimator::WindowEstimate>& windows,
                    const estimator::ParameterTable& table, const Eigen::VectorXd& truth,
                    ErrorsByKind& errors);

}  // namespace framewatch::daemon
