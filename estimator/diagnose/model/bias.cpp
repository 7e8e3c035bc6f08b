#include "estimator/diagnose/model/bias.h"

#include <algorithm>
#include <cmath>

#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kPeriods = 4;  ///< of the band's lower end in one mean
constexpr Index kLeastMeans = 12;
constexpr double kLeastShare = 0.02;  ///< of an axis' rms
constexpr double kBeyondOthers = 5;   ///< times the median of all axes
constexpr double kSignificance = 30;  ///< F of two parameters
constexpr double kOnsetStep = 0.05;   ///< of the segment
constexpr double kLatestOnset = 0.85;

/// Tapered means over overlapping spans, one column per axis, and the middle of each span, s. The
/// taper suppresses the building's motion.
struct Means {
  MatrixXd value;
  VectorXd time;
};

Means means_of(const RecordSegment& s) {
  const double span_s = std::max(1.0, kPeriods * 2 * M_PI / s.w[0]);
  const auto length = std::max<Index>(2, static_cast<Index>(std::lround(span_s * s.rate_hz)));
  const Index hop = length / 2;
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
};

/// Least squares over the onset, of means of one axis.
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
    best.ramp = {c[1], from, std::sqrt(std::max(total - rest, 0.0) / static_cast<double>(count))};
    best.significance =
        0.5 * (total - rest) / std::max(rest / static_cast<double>(count - 3), 1e-300);
  }
  return best;
}

}  // namespace

std::optional<Ramp> find_ramp(const Plant& plant, const RecordSegment& s, Index axis) {
  const Means means = means_of(s);
  if (means.time.size() < kLeastMeans) return std::nullopt;
  std::vector<double> others;
  for (Index a = 0; a < plant.axis_count(); ++a)
    if (a != axis) others.push_back(fit_of(means, a, s.seconds()).ramp.rms);
  if (others.empty()) return std::nullopt;
  std::nth_element(others.begin(), others.begin() + static_cast<long>(others.size() / 2),
                   others.end());
  const Fit own = fit_of(means, axis, s.seconds());
  const double rms =
      std::sqrt(s.accel.col(axis).squaredNorm() / static_cast<double>(s.accel.rows()));
  const bool stands_out = own.significance > kSignificance && own.ramp.rms > kLeastShare * rms &&
                          own.ramp.rms > kBeyondOthers * others[others.size() / 2];
  return stands_out ? std::optional<Ramp>(own.ramp) : std::nullopt;
}

RecordSegment without_ramp(const RecordSegment& s, Index axis, const Ramp& ramp) {
  MatrixXd accel = s.accel;
  for (Index i = 0; i < accel.rows(); ++i)
    accel(i, axis) -= ramp.slope * std::max(static_cast<double>(i) / s.rate_hz - ramp.from_s, 0.0);
  const double step = s.w.size() > 1 ? s.w[1] - s.w[0] : 1;
  const Band band{(s.w[0] - 0.25 * step) / (2 * M_PI),
                  (s.w[s.w.size() - 1] + 0.25 * step) / (2 * M_PI)};
  return make_segment(accel, s.rate_hz, s.variance.cwiseSqrt(), band, s.displaced);
}

}  // namespace framewatch::estimator
