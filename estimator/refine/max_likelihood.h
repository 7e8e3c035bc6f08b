// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "estimator/refine/spectrum.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// bad_input: wrong sizes, or a rate or parameter that is not > 0. bad_samples: not finite.
enum class SegmentStatus { good, bad_input, missing_sensors, bad_samples, too_short };

/// Cramer-Rao bound: the least standard deviation of any unbiased estimator.
struct CramerRaoBound {
  SegmentStatus status = SegmentStatus::bad_input;
  Eigen::VectorXd std_error;  ///< theta order, SI; infinite where the motion has no information
  Band band;
  int bins = 0;
};

/// Returns the bound of all parameters together from one segment. Every axis has independent white
/// noise (SensorAxis::noise_density); the input and the states at both ends are unknown. theta: the
/// true parameters, > 0. accel_abs: instants x axes, exact, m/s^2.
CramerRaoBound cramer_rao_bound(const Structure& structure, const std::vector<SensorAxis>& axes,
                                const Eigen::VectorXd& theta, double rate_hz,
                                const Eigen::MatrixXd& accel_abs);

/// Returns good if theta can be estimated from the segment, else the reason.
SegmentStatus check_segment(const Structure& structure, const std::vector<SensorAxis>& axes,
                            const Eigen::VectorXd& theta, double rate_hz,
                            const Eigen::MatrixXd& accel_abs);

/// Returns the square roots of the diagonal of the inverse of an information matrix; infinite for
/// parameters with a share in a direction without information.
Eigen::VectorXd bound_of(const Eigen::MatrixXd& information);

struct RefineOptions {
  bool prior = true;          ///< weak prior around the design, as in the streaming estimator
  int max_iterations = 50;    ///< Gauss-Newton steps
  double tolerance = 0.01;    ///< converged when a step is below this many standard errors
  double longest_step = 0.3;  ///< largest step of any parameter, relative to the design
  std::function<void(int)> progress = {};  ///< called with the number of each step, from 1
};

/// converged, not_converged: all members are set; otherwise only `status` is. quiet: no frame
/// stiffness exceeds the sensor noise. failed: the likelihood cannot be computed at some theta.
enum class RefineStatus {
  converged,
  not_converged,
  bad_input,
  missing_sensors,
  bad_samples,
  too_short,
  quiet,
  failed
};

/// Maximum-likelihood estimate from a stored segment, theta order, SI.
struct Refinement {
  RefineStatus status = RefineStatus::bad_input;
  Eigen::VectorXd theta;
  Eigen::VectorXd std_error;   ///< includes prior, regressor noise and misfit
  Eigen::MatrixXd covariance;  ///< of theta; its diagonal is the square of std_error
  Eigen::VectorXd bound;  ///< Cramer-Rao bound at theta without prior; infinite: no information
  int iterations = 0;
  double log_likelihood = 0;
  double misfit_ratio = 0;  ///< misfit over its expectation under sensor noise; 1: fits
  Band band;
  int bins = 0;

  bool has_values() const {
    return status == RefineStatus::converged || status == RefineStatus::not_converged;
  }
};

/// Returns the errors-in-variables maximum-likelihood estimate (with the prior: maximum posterior)
/// from a segment of calibrated samples, docs/equations.md (31)-(38). Never throws. accel_abs:
/// instants x axes, m/s^2. design, start: theta order, > 0.
Refinement refine_max_likelihood(const Structure& structure, const std::vector<SensorAxis>& axes,
                                 double rate_hz, const Eigen::MatrixXd& accel_abs,
                                 const Eigen::VectorXd& design, const Eigen::VectorXd& start,
                                 const RefineOptions& options = {});

/// Refines config.parameters(), which are groups of stories if floors have no sensors. design,
/// start: in that order, > 0.
Refinement refine_max_likelihood(const PipelineConfig& config, const Eigen::MatrixXd& accel_abs,
                                 const Eigen::VectorXd& design, const Eigen::VectorXd& start,
                                 const RefineOptions& options = {});

/// Returns the status in words: "converged", "not converged", "quiet", ...
const char* status_word(RefineStatus status);

}  // namespace framewatch::estimator
