// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/base/workers.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// Counts of published parameters of a building at one level of motion. The sensors' noise stays
/// while the motion fades from level to level.
struct ExcitationLevel {
  double noise_ratio;  ///< noise of the sensors over the rms of the motion
  /// By ParameterKind: parameters in all windows, published ones, and published ones that are wrong
  /// by more than kWrong.
  std::array<int, 4> all{}, published{}, wrong{};
};
/// 5 % in frame stiffness, 25 % in the others.
inline constexpr std::array<double, 4> kWrong = {0.05, 0.25, 0.25, 0.25};

struct ExcitationSweep {
  std::string name;
  std::vector<ExcitationLevel> levels;

  int published(int kind) const;
  /// Returns the wrong share of the published parameters.
  double wrong_ratio(int kind) const;
};

/// Runs noise from 0.3 % to 3000 % of the motion on 15-s motions 1 .. seeds. The design is off by
/// up to 20 % in k and 40 % in the rest. noise_configured: the estimator knows the noise densities.
ExcitationSweep study_excitation(const std::string& name, const estimator::Structure& structure,
                                 const Eigen::VectorXd& truth, bool noise_configured, int seeds,
                                 const Workers& workers);

/// Counts of windows of sensor noise alone.
struct Silence {
  std::string name;
  double hours;
  bool noise_configured;
  std::int64_t windows = 0;    ///< full ones
  std::int64_t published = 0;  ///< windows with at least one value
};

/// Runs white noise of 1e-3 m/s^2 rms on every axis for silence.hours and counts into `silence`.
void listen_to_noise(const estimator::Structure& structure, const Eigen::VectorXd& design,
                     Silence& silence);

/// Returns the largest relative change of a frame stiffness when every channel gets a bias of 0.05
/// m/s^2 and a thermal ramp of 0.001 m/s^2 per s. Exact motion, 5-s windows from 10 s to 15 s.
double change_by_bias(const estimator::Structure& structure, const Eigen::VectorXd& truth,
                      std::uint64_t seed);

}  // namespace framewatch::daemon
