// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The frequency band in which a segment is compared with the equations, Hz.
struct Band {
  double low_hz = 0;
  double high_hz = 0;
};

/// Returns the band from 0.4 times the lowest natural frequency to three times the highest, at most
/// 0.4 of the sampling rate.
Band structure_band(const Structure& structure, const ParameterTable& table,
                    const Eigen::VectorXd& theta, double rate_hz);

/// The discrete Fourier transform (trapezoidal sums) of a segment for the bins inside a band.
struct Spectrum {
  Band band;               ///< from the first bin to the last
  Eigen::VectorXd w;       ///< rad/s, ascending
  Eigen::MatrixXcd accel;  ///< axes x bins, sum of samples, m/s^2
  double intervals = 0;  ///< number of intervals; noise of variance v has intervals * v in each bin

  Eigen::Index bins() const { return w.size(); }
};

/// accel: instants x axes, m/s^2, finite. delay: s, per axis; compensated.
Spectrum spectrum_of(const Eigen::MatrixXd& accel, const Eigen::VectorXd& delay, double rate_hz,
                     const Band& band);

}  // namespace framewatch::estimator
