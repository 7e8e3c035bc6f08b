// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/gap.h"
#include "estimator/diagnose/model/plant.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

// The functions below describe the part of the records that models leave. `before` and `after`:
// gaps of every segment, of the model without and with the effects. from: first segment to use.
// Every result is empty without segments, and its `after` is empty if a run of that model diverges.

/// Amplitude densities over frequency, rms over the output axes and the segments, in the unit of
/// Gap::difference per sqrt(Hz).
struct ResidualSpectrum {
  Eigen::VectorXd hz;                    ///< middles of equal bands
  Eigen::VectorXd measured;              ///< the measurement
  Eigen::VectorXd before, after, noise;  ///< what is left, and what noise alone would leave
};
ResidualSpectrum residual_spectrum(const Plant& plant, const std::vector<RecordSegment>& segments,
                                   const std::vector<Gap>& before, const std::vector<Gap>& after,
                                   std::size_t from);

/// The gap of one floor: NRMSE over its output axes, mean over the segments.
struct FloorGap {
  int story = 0;
  double before = 0, after = 0;
  double floor = 0;  ///< from noise alone
};
/// Returns the gaps of the floors with output axes, the lowest first. `after` is NaN if unknown.
std::vector<FloorGap> floor_gaps(const Plant& plant, const std::vector<RecordSegment>& segments,
                                 const std::vector<Gap>& before, const std::vector<Gap>& after,
                                 std::size_t from);

/// Autocorrelation of what is left, each channel and frequency divided by its noise. Noise alone
/// would leave a white signal, so that every value would be near zero. Lags are multiples of half
/// the inverse bandwidth, at which white noise of that band is uncorrelated.
struct ResidualCorrelation {
  Eigen::VectorXd lag_s;
  Eigen::VectorXd before, after;  ///< 1 at lag 0, which is left out
  double white_band = 0;  ///< values of white noise, even if all channels share it, lie within this
                          ///< at 95 % of the lags
  int before_outside = 0, after_outside = 0;  ///< number of lags outside
  double before_level = 0, after_level = 0;   ///< rms of what is left, over that of noise
};
ResidualCorrelation residual_correlation(const Plant& plant,
                                         const std::vector<RecordSegment>& segments,
                                         const std::vector<Gap>& before,
                                         const std::vector<Gap>& after, std::size_t from);

/// Returns true if more of `lags` lags are outside the band than chance puts there: more than 5 %
/// and two standard deviations.
bool is_patterned(int outside, Eigen::Index lags);

}  // namespace framewatch::estimator
