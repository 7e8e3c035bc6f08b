#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/refine/spectrum.h"

namespace framewatch::estimator {

/// One segment of a record for a diagnosis: all axes, calibrated, evenly sampled, m/s^2.
struct RecordSegment {
  double rate_hz = 0;
  Eigen::MatrixXd accel;  ///< instants x axes, without their means
  /// Instants before them, where the simulation of a record that begins in motion starts.
  Eigen::MatrixXd lead;
  /// Axes that measure displacement relative to the ground, m; their spectra are of acceleration.
  std::vector<char> displaced;
  Eigen::VectorXd variance;  ///< of one sample's white noise, per axis
  /// Toward low frequencies the noise of all axes grows: its density is white times 1 + corner_hz
  /// over the frequency.
  double corner_hz = 0;
  Eigen::VectorXd w;  ///< rad/s of the bins in the band
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

/// accel: instants x axes, finite; the first `lead` become RecordSegment::lead, the rest is cut to
/// a length with a fast transform. noise: standard deviation of one sample per axis; 0: estimated
/// from the record.
RecordSegment make_segment(const Eigen::MatrixXd& accel, double rate_hz,
                           const Eigen::VectorXd& noise, const Band& band,
                           const std::vector<char>& displaced = {}, Eigen::Index lead = 0);

/// Variance of one sample's white noise, from the spectrum between `low` and 0.46 of the sampling
/// rate in the quietest fifth of the seconds.
double quiet_noise_variance(const Eigen::VectorXd& accel, double rate_hz, double low = 0.20);

/// Spectrum of a signal of `intervals * ratio` samples in the segment's band, scaled as the sum of
/// `intervals` samples.
Eigen::VectorXcd band_of(const Eigen::VectorXd& fine, const RecordSegment& segment, int ratio);

/// The signal of `intervals * ratio` samples with this spectrum in the band and zero elsewhere.
Eigen::VectorXd signal_of(const Eigen::VectorXcd& bins, const RecordSegment& segment, int ratio);

}  // namespace framewatch::estimator
