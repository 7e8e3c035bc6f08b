#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// The shaking that a prediction is for: stationary white noise through the ground's resonance
/// (Kanai-Tajimi) and a high-pass against drift.
struct ExpectedShaking {
  double rms_mps2 = 0.2;
  double ground_frequency_hz = 2.5;
  double ground_damping_ratio = 0.6;
};

/// How far the design inside a group may be off, relative standard deviations.
struct DesignTolerance {
  double profile = 0.05;  ///< of a story's share in its group's flexibility
  double mass = 0.02;     ///< of a floor's mass
};

/// What a layout of few sensors can be expected to show, before a sensor is bought.
struct LayoutPrediction {
  /// By parameter (config.parameters()), relative: standard error of one window from the sensors'
  /// noise, and the constant error from a design that is off by its tolerance. NaN: not identified.
  std::vector<double> window_error, design_error;
  /// By frame story (Structure::dof), relative: loss of stiffness that changes a group by four
  /// standard errors of a difference of two windows. Infinite: never.
  std::vector<double> smallest_loss;
  /// What a small loss in one story makes of the groups' values. By element: rms over its stories
  /// of the change of its value over that of its stiffness, less 1. Element by element, by the one
  /// with the loss first: largest change of the other one's value over that of its own value.
  /// Empty: not identified.
  std::vector<double> change_error, change_leak;
};

/// config: of groups. noise_density: of every axis, m/s^2/sqrt(Hz), > 0.
/// Source: docs/equations.md (53) and (54).
LayoutPrediction predict_layout(const PipelineConfig& config,
                                const std::vector<double>& noise_density,
                                const ExpectedShaking& shaking,
                                const DesignTolerance& tolerance = {});

}  // namespace framewatch::estimator
