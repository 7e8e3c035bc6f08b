// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/effect.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The errors of one accelerometer axis, applied in this order: gain, noise, bias and thermal ramp,
/// saturation, quantization, loss, inverse calibration. SI.
struct SensorModel {
  double noise_density = 0;  ///< white, one-sided, m/s^2/sqrt(Hz)
  double bias = 0;           ///< m/s^2
  double thermal_ramp = 0;   ///< m/s^2 per s, added to the bias from time 0 on
  double bias_per_degc = 0;  ///< m/s^2 per degC, added to the bias
  double gain_per_degc = 0;  ///< relative, per degC
  double clip_level = 0;     ///< m/s^2: limit before the converter; 0: unlimited
  double full_scale = 0;     ///< m/s^2: values are limited to + and - this; 0: unlimited
  int bits = 0;              ///< of the converter over the full scale; 0: no quantization
  double loss_ratio = 0;     ///< 0..1, probability that a sample is lost
  double dead_from_s = std::numeric_limits<double>::infinity();  ///< no samples from here on
  double dead_to_s = std::numeric_limits<double>::infinity();    ///< and before here
};

/// Returns every rule that `model` breaks.
std::vector<std::string> problems(const SensorModel& model);

/// Returns the noise density, m/s^2/sqrt(Hz), of samples at rate_hz whose rms is `ratio` times
/// `rms`.
double noise_density_of(double ratio, double rms, double rate_hz);

/// Returns the motion that every axis senses, including its delay.
std::vector<ResponseChannel> response_channels(const Structure& structure,
                                               const std::vector<SensorAxis>& axes);

/// Simulates all axes of a building. Samples are reproducible by seed; every axis has independent
/// random numbers.
class SensorArray {
 public:
  /// models: one per axis. rate_hz: of the instants given to measure().
  SensorArray(std::vector<SensorAxis> axes, std::vector<SensorModel> models, double rate_hz,
              std::uint64_t seed);

  /// Returns the raw values of the next instant in axis order, NaN for lost samples; SensorAxis'
  /// calibration turns them back into m/s^2. motion: sensed by every axis, m/s^2. warmer_degc: than
  /// at the calibration.
  const std::vector<double>& measure(double time_s, const Eigen::VectorXd& motion,
                                     double warmer_degc = 0);

 private:
  std::vector<SensorAxis> axes_;
  std::vector<SensorModel> models_;
  std::vector<Random> noise_;
  std::vector<Random> loss_;
  double noise_gain_;  ///< sqrt(Hz): density to standard deviation of a sample
  std::vector<double> raw_;
};

/// Applies the effects of channels to the sensed motion, in the order of the list. Time shifts
/// delay the response channel and clipping limits the sensor instead.
class ChannelEffects {
 public:
  /// Effects of other kinds are ignored. Precondition: problems() of each is empty.
  explicit ChannelEffects(std::vector<Effect> effects);

  void delay(std::vector<ResponseChannel>& channels) const;
  void limit(std::vector<SensorModel>& models) const;
  /// Returns the readings of the axes for the motion that they sense, m/s^2, both in axis order.
  const Eigen::VectorXd& apply(double time_s, const Eigen::VectorXd& motion);

 private:
  std::vector<Effect> effects_;
  Eigen::VectorXd out_;
};

}  // namespace framewatch::estimator
