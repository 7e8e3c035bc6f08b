// SPDX-License-Identifier: MIT
#include "estimator/diagnose/spectra/record_segment.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <vector>

#include "estimator/diagnose/spectra/fourier.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double kComponentLow =
    0.40;  ///< of the sampling rate; component tests excite higher frequencies
constexpr double kNoiseLow = 0.20;   ///< of the sampling rate
constexpr double kNoiseHigh = 0.46;  ///< of the sampling rate
constexpr double kQuietShare = 0.2;
constexpr double kMinVariance = 1e-16;  ///< (m/s^2)^2, for exact data

/// Returns the mean of the periodogram between `low` and kNoiseHigh, per sample.
double high_variance(const VectorXd& block, double low) {
  const Index size = block.size();
  VectorXd tapered = block.array() - block.mean();
  double power = 0;
  for (Index i = 0; i < size; ++i) {
    const double taper =
        0.5 - 0.5 * std::cos(2 * M_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(size));
    tapered[i] *= taper;
    power += taper * taper;
  }
  const VectorXcd half = forward_fourier(tapered);
  double sum = 0;
  int count = 0;
  for (Index k = 0; k < half.size(); ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(size);
    if (share < low || share > kNoiseHigh) continue;
    sum += std::norm(half[k]);
    ++count;
  }
  return count > 0 ? sum / count / power : 0;
}

}  // namespace

double quiet_noise_variance(const VectorXd& accel, double rate_hz, double low) {
  const Index block = smooth_size(std::max<Index>(32, static_cast<Index>(std::lround(rate_hz))));
  std::vector<double> levels;
  for (Index at = 0; at + block <= accel.size(); at += block)
    levels.push_back(high_variance(accel.segment(at, block), low));
  if (levels.empty()) return kMinVariance;
  std::sort(levels.begin(), levels.end());
  const auto kept = std::max<std::size_t>(
      1, static_cast<std::size_t>(kQuietShare * static_cast<double>(levels.size())));
  double log_sum = 0;
  for (std::size_t i = 0; i < kept; ++i) log_sum += levels[i];
  const double mean = log_sum / static_cast<double>(kept);
  // The quietest fifth of Gaussian estimates lies 1.40 standard deviations below their mean.
  const double averaged = static_cast<double>(block) * (kNoiseHigh - low) / 1.94;
  return std::max(kMinVariance, mean / std::max(0.5, 1 - 1.40 / std::sqrt(averaged)));
}

RecordSegment make_segment(const Eigen::MatrixXd& record, double rate_hz, const VectorXd& noise,
                           const Band& band, const std::vector<char>& displaced, Index lead) {
  RecordSegment out;
  const Eigen::MatrixXd accel = record.bottomRows(record.rows() - lead);
  out.displaced = displaced;
  out.rate_hz = rate_hz;
  const Index intervals = smooth_size(std::max<Index>(accel.rows() - 1, 0));
  out.accel = accel.topRows(intervals + 1);
  const Eigen::RowVectorXd mean = out.accel.colwise().mean();
  out.accel.rowwise() -= mean;
  out.lead = record.topRows(lead).rowwise() - mean;
  out.variance.resize(accel.cols());
  for (Index a = 0; a < accel.cols(); ++a)
    out.variance[a] =
        noise[a] > 0 ? noise[a] * noise[a]
                     : quiet_noise_variance(accel.col(a), rate_hz,
                                            std::count(displaced.begin(), displaced.end(), 1) > 0
                                                ? kComponentLow
                                                : kNoiseLow);

  const double step_hz = rate_hz / static_cast<double>(std::max<Index>(intervals, 1));
  out.first_bin = std::max<Index>(1, static_cast<Index>(std::ceil(band.low_hz / step_hz)));
  const Index last =
      std::min<Index>((intervals - 1) / 2, static_cast<Index>(std::floor(band.high_hz / step_hz)));
  const Index bins = std::max<Index>(0, last - out.first_bin + 1);
  out.w.resize(bins);
  for (Index b = 0; b < bins; ++b)
    out.w[b] = 2 * M_PI * step_hz * static_cast<double>(out.first_bin + b);
  out.spectrum.resize(accel.cols(), bins);
  for (Index a = 0; a < accel.cols() && bins > 0; ++a) {
    VectorXd periodic = out.accel.col(a).head(intervals);
    periodic[0] = 0.5 * (out.accel(0, a) + out.accel(intervals, a));
    out.spectrum.row(a) = forward_fourier(periodic).segment(out.first_bin, bins).transpose();
    if (out.is_displaced(a)) out.spectrum.row(a).array() *= -out.w.transpose().array().square();
  }
  return out;
}

VectorXcd band_of(const VectorXd& fine, const RecordSegment& segment, int ratio) {
  return forward_fourier(fine).segment(segment.first_bin, segment.bins()) / ratio;
}

VectorXd signal_of(const VectorXcd& bins, const RecordSegment& segment, int ratio) {
  VectorXcd half = VectorXcd::Zero(segment.first_bin + bins.size());
  half.tail(bins.size()) = bins;
  return ratio * inverse_fourier(half, segment.intervals() * ratio);
}

}  // namespace framewatch::estimator
