// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/diagnose/fit/fit.h"

namespace framewatch::estimator {

/// Mean square of the residual in neighboring bins of one equation.
struct NoiseCell {
  double hz, now_hz;  ///< frequency; corner frequency of the present weights
  double level;       ///< 1: noise as assumed in the weights
  double numbers;

  /// Returns the noise with this corner frequency over the noise assumed in the weights.
  double expected(double corner_hz) const { return (1 + corner_hz / hz) / (1 + now_hz / hz); }
};

inline constexpr Eigen::Index kBinsOfCell = 24;
/// Returns the most likely corner frequency of the noise (RecordSegment::corner_hz).
double likeliest_corner_hz(const std::vector<NoiseCell>& cells);
/// Returns the mean square excess of the cells over noise with this corner frequency, in units of
/// such noise. Only excess counts: a missing effect leaves more than noise, and less than noise
/// comes from unequal channels.
double spread_of(const std::vector<NoiseCell>& cells, double corner_hz);

/// Sets the corner frequency of all segments.
void set_corner(double corner_hz, std::vector<RecordSegment>& segments);

/// Checks if a fit leaves only noise that grows toward low frequencies (RecordSegment::corner_hz):
/// equal in all equations and smooth over frequency. If so, sets the corner frequency in the
/// segments, fits again and returns true. segments: those of the fitter.
bool fit_noise_corner(const Fitter& fitter, std::vector<RecordSegment>& segments, FitResult& now);

}  // namespace framewatch::estimator
