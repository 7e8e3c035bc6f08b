#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/refine/spectrum.h"

namespace framewatch {

/// One recorded stretch that a diagnosis looks at: all axes, calibrated, evenly sampled, m/s^2.
struct Stretch {
  double rate_hz = 0;
  Eigen::MatrixXd accel;  ///< instants x axes, without their means
  /// The same of the instants before, of a record that begins in motion: a simulation starts there.
  Eigen::MatrixXd lead;
  /// Axes that measure displacement relative to the ground, m: their spectra are of acceleration.
  std::vector<char> displaced;
  Eigen::VectorXd variance;  ///< of one sample's white noise, per axis
  Eigen::VectorXd w;         ///< rad/s of the bins in the band
  Eigen::Index first_bin = 0;
  Eigen::MatrixXcd spectrum;  ///< axes x bins, sum of samples

  Eigen::Index bins() const { return w.size(); }
  Eigen::Index intervals() const { return accel.rows() - 1; }
  bool is_displaced(Eigen::Index axis) const {
    return static_cast<std::size_t>(axis) < displaced.size() &&
           displaced[static_cast<std::size_t>(axis)];
  }
  double seconds() const { return static_cast<double>(intervals()) / rate_hz; }
};

/// accel: instants x axes, finite; cut to a length that transforms fast, the first `lead` of them
/// are Stretch::lead. noise: sd per axis of one sample, 0 where it is to be taken from the record
/// itself.
Stretch make_stretch(const Eigen::MatrixXd& accel, double rate_hz, const Eigen::VectorXd& noise,
                     const Band& band, const std::vector<char>& displaced = {},
                     Eigen::Index lead = 0);

/// Variance of one sample's white noise, from what lies between 20 and 46 % of the sampling rate in
/// the quietest fifth of the seconds; low: another share than 20 %.
double quiet_noise_variance(const Eigen::VectorXd& accel, double rate_hz, double low = 0.20);

/// The band's bins of a signal of `intervals * ratio` samples, as sum of `intervals` samples.
Eigen::VectorXcd band_of(const Eigen::VectorXd& fine, const Stretch& stretch, int ratio);

/// The signal of intervals * ratio samples that has these bins of the band and no others.
Eigen::VectorXd signal_of(const Eigen::VectorXcd& bins, const Stretch& stretch, int ratio);

}  // namespace framewatch
