#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// What one accelerometer axis does to the motion, in this order: noise, bias and thermal ramp,
/// saturation, quantisation, loss; then its inverse calibration. SI.
struct SensorModel {
  double noise_density = 0;  ///< white, one-sided, m/s^2/sqrt(Hz)
  double bias = 0;           ///< m/s^2
  double thermal_ramp = 0;   ///< m/s^2 per s, added to the bias from time 0 on
  double clip_level = 0;     ///< m/s^2: likewise, before the converter; 0 = unlimited
  double full_scale = 0;     ///< m/s^2: values stop at + and - this; 0 = unlimited
  int bits = 0;              ///< of the converter over the full scale; 0 = no quantisation
  double loss_ratio = 0;     ///< 0..1, chance of every sample to be lost
  double dead_from_s = std::numeric_limits<double>::infinity();  ///< no samples from here
  double dead_to_s = std::numeric_limits<double>::infinity();    ///< to before here
};

/// Every way in which `model` is impossible.
std::vector<std::string> problems(const SensorModel& model);

/// Noise density, m/s^2/sqrt(Hz), whose samples at rate_hz have `ratio` times the rms `rms`.
double noise_density_of(double ratio, double rms, double rate_hz);

/// What every axis senses, its delay included.
std::vector<ResponseChannel> response_channels(const Structure& structure,
                                               const std::vector<SensorAxis>& axes);

/// All axes of a building. The same seed gives the same samples; every axis has random numbers of
/// its own, independent of the others.
class SensorArray {
 public:
  /// One model per axis; rate_hz is that of the instants given to measure().
  SensorArray(std::vector<SensorAxis> axes, std::vector<SensorModel> models, double rate_hz,
              std::uint64_t seed);

  /// Raw values of the next instant in axis order, NaN where lost: what SensorAxis' calibration
  /// turns back into m/s^2. `motion` has what every axis senses.
  const std::vector<double>& measure(double time_s, const Eigen::VectorXd& motion);

 private:
  std::vector<SensorAxis> axes_;
  std::vector<SensorModel> models_;
  std::vector<Random> noise_;
  std::vector<Random> loss_;
  double noise_gain_;  ///< sqrt(Hz): density to standard deviation of a sample
  std::vector<double> raw_;
};

}  // namespace framewatch::estimator
