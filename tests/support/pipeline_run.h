// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <vector>

#include "estimator/pipeline/pipeline.h"

namespace framewatch::test {

/// Absolute accelerations of a building shaken obliquely by a strong seeded Kanai-Tajimi motion:
/// instants x axes of full_sensor_axes(). noise_ratio: white noise of every axis, share of its rms.
Eigen::MatrixXd shaken(const estimator::Structure& structure, const Eigen::VectorXd& theta,
                       double rate_hz, double duration_s, double noise_ratio = 0);

/// Returns a configuration with sensors everywhere and no design.
estimator::PipelineConfig pipeline_config(const estimator::Structure& structure,
                                          double rate_hz = 100);

/// Decides whether a sample is delivered: (instant, axis).
using Delivered = std::function<bool(int, int)>;

/// The output of a pipeline for these accelerations, with the first instant at time 0, and its
/// counters at the end.
struct PipelineRun {
  std::vector<estimator::WindowEstimate> estimates;
  estimator::PipelineCounters counters;
};
PipelineRun run_pipeline(const estimator::PipelineConfig& config, const Eigen::MatrixXd& accel,
                         const Delivered& delivered = {});

/// Returns the sample of an axis at an instant.
estimator::AccelSample sample_at(const Eigen::MatrixXd& accel, double rate_hz, int instant,
                                 int axis);

}  // namespace framewatch::test
