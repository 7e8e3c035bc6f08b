#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/pipeline.h"
#include "estimator/simulate/ground_motion.h"

namespace framewatch::test {

/// One run of the whole pipeline on exact motion of a known building with noisy accelerometers.
struct AccuracyTrial {
  Structure structure;
  Eigen::VectorXd truth;   ///< theta order, SI
  Eigen::VectorXd design;  ///< what the estimator is told
  PlanMotion motion;
  double duration_s = 15;
  double noise_ratio = 0;  ///< white noise of each axis over the rms of its motion
  std::uint64_t seed = 1;
  EstimatorOptions options;
  double every_s = 1;  ///< full windows are kept at this distance
};

/// The full windows of the run, every_s apart.
std::vector<WindowEstimate> run_trial(const AccuracyTrial& trial);

/// truth with every stiffness off by at most stiffness_off and every other parameter by at most
/// other_off, relative, signs and sizes drawn by seed.
Eigen::VectorXd perturbed_design(const ParameterTable& table, const Eigen::VectorXd& truth,
                                 double frame_stiffness_off, double other_off, std::uint64_t seed);

/// Errors of one kind of parameter over windows and trials.
struct ErrorStatistics {
  std::vector<double> relative_error;  ///< |solution / truth - 1|, published or not
  int published = 0;
  int covered = 0;  ///< published with truth inside the 95 % interval

  double quantile(double probability) const;
  double published_ratio() const;
  double coverage_ratio() const;  ///< NaN when nothing was published
};

/// By ParameterKind.
using ErrorsByKind = std::array<ErrorStatistics, 4>;

void collect_errors(const std::vector<WindowEstimate>& windows, const ParameterTable& table,
                    const Eigen::VectorXd& truth, ErrorsByKind& errors);

}  // namespace framewatch::test
