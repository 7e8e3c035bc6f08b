#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/base/workers.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {

/// What is published of a building whose sensors' noise stays while its motion fades.
struct ExcitationLevel {
  double noise_ratio;  ///< noise of the sensors over the rms of the motion
  /// By ParameterKind: parameters in all windows, published, published and wrong by more than
  /// kWrong.
  std::array<int, 4> all{}, published{}, wrong{};
};
/// 5 % in frame stiffness, 25 % in the others.
inline constexpr std::array<double, 4> kWrong = {0.05, 0.25, 0.25, 0.25};

struct ExcitationSweep {
  std::string name;
  std::vector<ExcitationLevel> levels;

  int published(int kind) const;
  /// Of the published ones.
  double wrong_ratio(int kind) const;
};

/// Noise from 0.3 % to 3000 % of the motion, 15-s motions 1 .. seeds, design off by up to 20 % in k
/// and 40 % in the rest. noise_configured: whether the estimator is told the noise densities.
ExcitationSweep study_excitation(const std::string& name, const estimator::Structure& structure,
                                 const Eigen::VectorXd& truth, bool noise_configured, int seeds,
                                 const Workers& workers);

/// Windows of nothing but sensor noise.
struct Silence {
  std::string name;
  double hours;
  bool noise_configured;
  std::int64_t windows = 0;    ///< full ones
  std::int64_t published = 0;  ///< windows with at least one value
};

/// White noise of 1e-3 m/s^2 rms on every axis for silence.hours; counts into silence.
void listen_to_noise(const estimator::Structure& structure, const Eigen::VectorXd& design,
                     Silence& silence);

/// Largest relative change of a frame stiffness when every channel gets a bias of 0.05 m/s^2 and a
/// thermal ramp of 0.001 m/s^2 per s: exact motion, 5-s windows from 10 s to 15 s.
double change_by_bias(const estimator::Structure& structure, const Eigen::VectorXd& truth,
                      std::uint64_t seed);

}  // namespace framewatch::daemon
