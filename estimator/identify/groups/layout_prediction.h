// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// The expected shaking: stationary white noise through the ground's resonance (Kanai-Tajimi) and a
/// high-pass against drift.
struct ExpectedShaking {
  double rms_mps2 = 0.2;
  double ground_frequency_hz = 2.5;
  double ground_damping_ratio = 0.6;
};

/// Relative standard deviations of the design within a group.
struct DesignTolerance {
  double profile = 0.05;  ///< of a story's share in its group's flexibility
  double mass = 0.02;     ///< of a floor's mass
};

/// Relative standard deviations of a sensor that meets the limits of README.md.
struct SensorTolerance {
  double gain = 0.002;
  double time_s = 1e-4;  ///< of its clock
};

/// The expected performance of a layout of few sensors, before a sensor is bought.
struct LayoutPrediction {
  /// By parameter (config.parameters()), relative. window_error: standard error of one window due
  /// to sensor noise. design_error: constant error of a design that is off by its tolerance.
  /// sensor_error: constant error of sensors that are off by theirs. NaN: not identified.
  std::vector<double> window_error, design_error, sensor_error;
  /// By frame story (Structure::dof), relative: loss of stiffness that changes a group by four
  /// standard errors of a difference of two windows. Infinite: cannot be detected.
  std::vector<double> smallest_loss;
  /// Effects of a small loss in one story; empty: not identified. change_error, by element: rms
  /// over its stories of the change of its value over the change of its stiffness, minus 1. Entry
  /// (i, k) of change_leak, row-major: largest change of the value of k over the change of the
  /// value of i, for a loss in i.
  std::vector<double> change_error, change_leak;
};

/// Predicts a layout. config: of a building in groups. noise_density: of every axis,
/// m/s^2/sqrt(Hz), > 0. Source: docs/equations.md (53) and
/// (54).
LayoutPrediction predict_layout(const PipelineConfig& config,
                                const std::vector<double>& noise_density,
                                const ExpectedShaking& shaking,
                                const DesignTolerance& tolerance = {},
                                const SensorTolerance& sensors = {});

}  // namespace framewatch::estimator
