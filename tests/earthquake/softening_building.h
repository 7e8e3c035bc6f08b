// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "estimator/simulate/decimator.h"
#include "estimator/simulate/element_law.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/sensors.h"

namespace framewatch::earthquake {

/// Dependence of the frames' stiffness on the amplitude of their motion.
enum class Softening {
  none,
  slow,     ///< k (1 - s A / (A + usual)), A the running rms drift: rises in 2 s, falls in 20 s
  slipping  ///< the catalogue's amplitude_dependence with half of it slip in joints, at 3 usual
};

/// A building of frames and panels on moving ground, computed element by element with central
/// differences at 0.5 ms (not the estimator's scheme) and sampled behind an anti-alias filter.
/// Frames may soften while they move; a loss of stiffness keeps the share of softening.
class SofteningBuilding {
 public:
  static constexpr double kRate_hz = 100;

  /// theta: in the order of ParameterTable(structure), SI. amount: s above, or the share lost at
  /// three times the usual drift. noise_ratio: of each channel, over the rms of its motion under
  /// shaking of level 1.
  SofteningBuilding(const estimator::Structure& structure, const Eigen::VectorXd& theta,
                    const std::vector<estimator::SensorAxis>& axes, Softening softening,
                    double amount, double noise_ratio, std::uint64_t seed);

  /// Standard deviation of every channel's noise, m/s^2.
  const std::vector<double>& sigma() const { return sigma_; }
  /// Sets the stiffness of all elements from now on, relative to the initial one, in the order of
  /// the stiffness half of theta. The motion continues.
  void set_remaining(const Eigen::VectorXd& remaining) { remaining_ = remaining; }
  /// Returns the channels' measurements at the next instant, m/s^2. level: of the ground's motion;
  /// 1: strong, about 1 m/s^2 rms.
  const Eigen::VectorXd& next(double level);

 private:
  struct Frame {
    double level = 0, usual = 0;  ///< running mean square drift, m^2; rms under shaking of level 1
    std::unique_ptr<estimator::ElementLaw> law;
    std::vector<double> states, rates;  ///< of the law
  };
  struct Ground {
    double moved = 0, velocity = 0, accel = 0;
  };
  void step(double level);
  void shake_ground(double level);
  double beyond_linear(std::size_t element, double drift, double rate);
  void learn_usual(double noise_ratio);
  void rest();

  estimator::Structure structure_;
  std::vector<estimator::Element> elements_;
  Eigen::VectorXd stiffness_, damping_, remaining_, mass_;
  Eigen::MatrixXd influence_;
  Softening softening_;
  double amount_;
  std::vector<Frame> frames_;
  Eigen::VectorXd moved_, velocity_, accel_, force_;
  Ground ground_[2];
  std::vector<int> sensed_;  ///< degree of freedom, or -1 - direction for the base
  std::vector<double> sigma_;
  estimator::Random ground_random_, noise_random_;
  std::unique_ptr<estimator::Decimator> decimator_;
  Eigen::VectorXd fine_, out_;
  double time_s_ = 0;
  bool linear_ = true;  ///< while the usual motion is learned
};

}  // namespace framewatch::earthquake
