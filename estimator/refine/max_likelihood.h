#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "estimator/refine/cramer_rao.h"
#include "estimator/refine/spectrum.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

struct RefineOptions {
  bool prior = true;          ///< weak prior around the design, as the streaming estimator's
  int max_iterations = 50;    ///< Gauss-Newton steps
  double tolerance = 0.01;    ///< converged when a step is below this many standard errors
  double longest_step = 0.3;  ///< of any parameter, relative to the design
  std::function<void(int)> progress = {};  ///< gets the number of each step, from 1
};

/// converged, not_converged: all members are set; any other: only `status` is. quiet: no frame
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
  Eigen::VectorXd std_error;  ///< includes prior, regressor noise and misfit
  Eigen::VectorXd bound;      ///< Cramer-Rao bound at theta without prior; infinite: no information
  int iterations = 0;
  double log_likelihood = 0;
  double misfit_ratio = 0;  ///< misfit over its expectation under sensor noise; 1: fits
  Band band;
  int bins = 0;

  bool has_values() const {
    return status == RefineStatus::converged || status == RefineStatus::not_converged;
  }
};

/// Errors-in-variables maximum likelihood (with the prior: maximum posterior) of a segment of
/// calibrated samples, docs/equations.md, maximum-likelihood refinement. Never throws.
/// accel_abs: instants x axes, m/s^2; design, start: > 0. Source: (31)-(38).
Refinement refine_max_likelihood(const Structure& structure, const std::vector<SensorAxis>& axes,
                                 double rate_hz, const Eigen::MatrixXd& accel_abs,
                                 const Eigen::VectorXd& design, const Eigen::VectorXd& start,
                                 const RefineOptions& options = {});

/// The same of any layout: config.parameters() are estimated, groups of stories where floors have
/// no sensor of their own. design, start: in that order, > 0.
Refinement refine_max_likelihood(const PipelineConfig& config, const Eigen::MatrixXd& accel_abs,
                                 const Eigen::VectorXd& design, const Eigen::VectorXd& start,
                                 const RefineOptions& options = {});

/// "converged", "not converged", "quiet", ...
const char* status_word(RefineStatus status);

}  // namespace framewatch::estimator
