// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/bias.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "estimator/numeric/quantile.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Periods of the band's lower end in one mean: the zeros of a Hann taper start there.
constexpr double kPeriods = 2;
constexpr Index kHops = 4;  ///< in one mean
constexpr Index kMinMeans = 23;
/// Periods of the band's lower end in a record. With fewer than kMinPeriods, slow motion of the
/// building resembles a small drift.
constexpr double kMinPeriods = 26, kFewPeriods = 6;
constexpr Index kFewMeans = 9;
constexpr double kMinShare = 0.02, kLargeShare = 0.04;  ///< of an axis' rms
constexpr double kBeyondOthers = 5, kFarBeyond = 15;    ///< times the median of all axes
constexpr double kSignificance = 30;                    ///< F of two parameters
constexpr double kOfFew = 3;         ///< F if there are few means, far beyond those of the others
constexpr double kOnsetStep = 0.05;  ///< of the segment
constexpr double kLatestOnset = 0.85;
constexpr Index kMaxCosines = 20;
constexpr double kFarBetter = 4;  ///< factor by which a curve must leave less than a ramp

/// Tapered means over overlapping spans, one column per axis, and the middle of each span, s. The
/// taper suppresses the building's motion.
struct Means {
  MatrixXd value;
  VectorXd time;
};

Means means_of(const RecordSegment& s) {
  const double span_s = std::max(1.0, kPeriods * 2 * M_PI / s.w[0]);
  const auto length = std::max<Index>(2, static_cast<Index>(std::lround(span_s * s.rate_hz)));
  const Index hop = std::max<Index>(1, length / kHops);
  const Index count = std::max<Index>(0, (s.accel.rows() - length) / hop + 1);
  VectorXd taper(length);
  for (Index i = 0; i < length; ++i)
    taper[i] =
        1 - std::cos(2 * M_PI * (static_cast<double>(i) + 0.5) / static_cast<double>(length));
  taper /= taper.sum();
  Means out{MatrixXd(count, s.accel.cols()), VectorXd(count)};
  for (Index i = 0; i < count; ++i) {
    out.value.row(i) = taper.transpose() * s.accel.middleRows(i * hop, length);
    out.time[i] = (static_cast<double>(i * hop) + 0.5 * static_cast<double>(length)) / s.rate_hz;
  }
  return out;
}

struct Fit {
  Ramp ramp;
  double significance = 0;
  double rest = 0;  ///< sum of squares of the means that the ramp leaves
};

/// Fits a ramp to the means of one axis by least squares, over a grid of onsets.
Fit fit_of(const Means& means, Index axis, double seconds) {
  const Index count = means.time.size();
  const VectorXd y = means.value.col(axis);
  const double total = (y.array() - y.mean()).matrix().squaredNorm();
  Fit best;
  double least = 1e300;
  for (double from = 0; from < kLatestOnset * seconds; from += kOnsetStep * seconds) {
    MatrixXd x(count, 2);
    x.col(0).setOnes();
    x.col(1) = (means.time.array() - from).max(0.0);
    const VectorXd c = LeastSquares(x).solve(y);
    const double rest = (y - x * c).squaredNorm();
    if (rest >= least) continue;
    least = rest;
    best.ramp = {
        c[1], from, std::sqrt(std::max(total - rest, 0.0) / static_cast<double>(count)), {}};
    // Means overlap, so fewer are independent.
    best.significance =
        0.5 * (total - rest) / kHops / std::max(rest / static_cast<double>(count - 3), 1e-300);
  }
  best.rest = least;
  return best;
}

MatrixXd cosines(const VectorXd& time, double seconds, Index count) {
  MatrixXd out(time.size(), count + 1);
  for (Index k = 0; k <= count; ++k)
    out.col(k) = (M_PI * static_cast<double>(k) / seconds * time.array()).cos();
  return out;
}

/// Returns the share of a cosine that a mean keeps: the response of a Hann taper. cycles: of the
/// cosine within it, below 1.
double kept(double cycles) {
  if (cycles == 0) return 1;
  return std::sin(M_PI * cycles) / (M_PI * cycles) / (1 - cycles * cycles);
}

/// Replaces the ramp by a slow curve, with its rms, if the curve follows the means far better.
void follow(const RecordSegment& s, const Means& means, Index axis, bool few, Fit& fit) {
  const double seconds = s.seconds();
  const double span_s = kHops * (means.time[1] - means.time[0]);
  const auto apart = static_cast<Index>((few ? 1.5 : 1) * seconds / span_s);
  const Index count = std::min({kMaxCosines, apart, means.time.size() / 2 - 1});
  if (count < 2) return;
  MatrixXd x = cosines(means.time, seconds, count);
  for (Index k = 1; k <= count; ++k)
    x.col(k) *= kept(0.5 * static_cast<double>(k) * span_s / seconds);
  const VectorXd y = means.value.col(axis), c = LeastSquares(x).solve(y);
  const double rest = (y - x * c).squaredNorm();
  const double total = (y.array() - y.mean()).matrix().squaredNorm();
  const auto left = static_cast<double>(y.size() - count - 1);
  const double significance =
      (total - rest) / kHops / static_cast<double>(count) / std::max(rest / left, 1e-300);
  if (kFarBetter * rest > fit.rest || significance < (few ? kOfFew : kSignificance)) return;
  VectorXd time(s.accel.rows());
  for (Index i = 0; i < time.size(); ++i) time[i] = static_cast<double>(i) / s.rate_hz;
  VectorXd slow = c;
  slow[0] = 0;  // the mean is not a drift
  fit.ramp.curve = cosines(time, seconds, count) * slow;
  fit.ramp.rms = std::sqrt(fit.ramp.curve.squaredNorm() / static_cast<double>(time.size()));
  fit.significance = significance;
}

/// Subtracts from the means of each axis the median of its direction: slow motion of the ground.
void remove_common(const Plant& plant, Means& means) {
  MatrixXd own = means.value;
  for (Index a = 0; a < plant.axis_count(); ++a) {
    const Direction along = plant.axes[static_cast<std::size_t>(a)].direction;
    std::vector<Index> alike;
    for (Index b = 0; b < plant.axis_count(); ++b)
      if (plant.axes[static_cast<std::size_t>(b)].direction == along &&
          plant.axes[static_cast<std::size_t>(b)].horizontal() && !plant.is_force(b))
        alike.push_back(b);
    const bool other = plant.is_force(a) || plant.axes[static_cast<std::size_t>(a)].vertical;
    if (alike.size() < 3 || other) continue;
    for (Index i = 0; i < means.value.rows(); ++i) {
      std::vector<double> values;
      for (const Index b : alike) values.push_back(means.value(i, b));
      own(i, a) -= upper_median(values);
    }
  }
  means.value = own;
}

}  // namespace

std::optional<Ramp> find_ramp(const Plant& plant, const RecordSegment& s, Index axis) {
  const double seconds = static_cast<double>(s.accel.rows()) / s.rate_hz;
  const double periods = seconds * s.w[0] / (2 * M_PI);
  if (periods < kFewPeriods) return std::nullopt;
  Means means = means_of(s);
  const bool few = periods < kMinPeriods || means.time.size() < kMinMeans;
  if (means.time.size() < kFewMeans) return std::nullopt;
  remove_common(plant, means);
  const auto fitted = [&](Index a) {
    Fit fit = fit_of(means, a, s.seconds());
    follow(s, means, a, few, fit);
    return fit;
  };
  std::vector<double> others;
  for (Index a = 0; a < plant.axis_count(); ++a)
    if (a != axis) others.push_back(fitted(a).ramp.rms);
  if (others.empty()) return std::nullopt;
  const Fit own = fitted(axis);
  const double rms =
      std::sqrt(s.accel.col(axis).squaredNorm() / static_cast<double>(s.accel.rows()));
  const bool stands_out = own.significance > (few ? kOfFew : kSignificance) &&
                          own.ramp.rms > (few ? kLargeShare : kMinShare) * rms &&
                          own.ramp.rms > (few ? kFarBeyond : kBeyondOthers) * upper_median(others);
  return stands_out ? std::optional<Ramp>(own.ramp) : std::nullopt;
}

RecordSegment without_ramp(const RecordSegment& s, Index axis, const Ramp& ramp) {
  MatrixXd accel = s.accel;
  if (ramp.curve.size() == accel.rows()) {
    accel.col(axis) -= ramp.curve;
  } else {
    for (Index i = 0; i < accel.rows(); ++i)
      accel(i, axis) -=
          ramp.slope * std::max(static_cast<double>(i) / s.rate_hz - ramp.from_s, 0.0);
  }
  const double step = s.w.size() > 1 ? s.w[1] - s.w[0] : 1;
  const Band band{(s.w[0] - 0.25 * step) / (2 * M_PI),
                  (s.w[s.w.size() - 1] + 0.25 * step) / (2 * M_PI)};
  return make_segment(accel, s.rate_hz, s.variance.cwiseSqrt(), band, s.displaced);
}

}  // namespace framewatch::estimator
