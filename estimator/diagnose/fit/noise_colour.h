#pragma once

#include <vector>

#include "estimator/diagnose/fit/fit.h"

namespace framewatch::estimator {

/// Mean square of what is left in neighbouring bins.
struct NoiseCell {
  double hz, now_hz;  ///< frequency, corner of the weights
  double level;       ///< 1: noise as it was taken to be
  double numbers;

  /// Noise with the corner over noise as it was taken to be.
  double expected(double corner_hz) const { return (1 + corner_hz / hz) / (1 + now_hz / hz); }
};

inline constexpr Eigen::Index kBinsOfCell = 24;
/// The corner of noise (RecordSegment::corner_hz) that the cells most likely are.
double likeliest_corner_hz(const std::vector<NoiseCell>& cells);
/// Mean square by which cells exceed noise with the corner, over that of such noise. What a model
/// lacks leaves more than noise; less is noise of unlike channels.
double spread_of(const std::vector<NoiseCell>& cells, double corner_hz);

/// Gives all segments a corner.
void set_corner(double corner_hz, std::vector<RecordSegment>& segments);

/// Where noise that grows toward low frequencies (RecordSegment::corner_hz) is all that a fit
/// leaves, alike in all equations and smooth over frequency: gives it to the segments, which are
/// those of the fitter, and fits again. Whether it did so.
bool colour_noise(const Fitter& fitter, std::vector<RecordSegment>& segments, FitResult& now);

}  // namespace framewatch::estimator
