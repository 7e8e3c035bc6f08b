// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/refine/spectrum.h"

namespace framewatch::estimator {

/// One segment of a record for a diagnosis: all axes, calibrated, evenly sampled, m/s^2.
struct RecordSegment {
  double rate_hz = 0;
  Eigen::MatrixXd accel;  ///< instants x axes, without their means
  /// Earlier instants, where the simulation of a record that begins in motion starts.
  Eigen::MatrixXd lead;
  /// True for axes that measure displacement relative to the ground, m. Their spectra are of
  /// acceleration.
  std::vector<char> displaced;
  Eigen::VectorXd variance;  ///< of one sample's white noise, per axis
  /// The noise of all axes grows toward low frequencies: its density is the white density times 1 +
  /// corner_hz over the frequency.
  double corner_hz = 0;
  /// Power of noise and the model's error over that of noise, for every bin. Empty: 1.
  Eigen::VectorXd model_error;
  Eigen::VectorXd w;  ///< rad/s of the bins in the band
  Eigen::Index first_bin = 0;
  Eigen::MatrixXcd spectrum;  ///< axes x bins, as sums over samples

  Eigen::Index bins() const { return w.size(); }
  Eigen::Index intervals() const { return accel.rows() - 1; }
  bool is_displaced(Eigen::Index axis) const {
    return static_cast<std::size_t>(axis) < displaced.size() &&
           displaced[static_cast<std::size_t>(axis)];
  }
  double seconds() const { return static_cast<double>(intervals()) / rate_hz; }
};

/// Returns a segment of a record. accel: instants x axes, finite. The first `lead` instants become
/// RecordSegment::lead; the rest is cut to a length with a fast transform. noise: standard
/// deviation of one sample per axis; 0: estimated from the record. displaced: as in RecordSegment.
RecordSegment make_segment(const Eigen::MatrixXd& accel, double rate_hz,
                           const Eigen::VectorXd& noise, const Band& band,
                           const std::vector<char>& displaced = {}, Eigen::Index lead = 0);

/// Returns the variance of one sample's white noise. Averages the spectrum between `low` and 0.46
/// of the sampling rate over the quietest fifth of the seconds.
double quiet_noise_variance(const Eigen::VectorXd& accel, double rate_hz, double low = 0.20);

/// Returns the spectrum of a signal of `intervals * ratio` samples in the segment's band, scaled as
/// a sum over `intervals` samples.
Eigen::VectorXcd band_of(const Eigen::VectorXd& fine, const RecordSegment& segment, int ratio);

/// Returns the signal of `intervals * ratio` samples with this spectrum in the band and zero
/// elsewhere.
Eigen::VectorXd signal_of(const Eigen::VectorXcd& bins, const RecordSegment& segment, int ratio);

}  // namespace framewatch::estimator
