// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/residual.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr Index kBands = 80;
constexpr Index kLags = 60;
constexpr Index kBinsPerLag = 4;
constexpr double kWithin = 1.96;  ///< standard deviations that hold 95 % of a normal value
constexpr double kOutside = 0.05;

bool is_whole(const std::vector<RecordSegment>& segments, const std::vector<Gap>& gaps) {
  return gaps.size() >= segments.size();
}

/// Returns |measured|^2 of an axis in a bin, in the unit of Gap::difference.
double measured_power(const RecordSegment& s, Index axis, Index bin) {
  return std::norm(s.spectrum(axis, bin)) / (s.is_displaced(axis) ? std::pow(s.w[bin], 4) : 1.0);
}

double outputs_of(const Plant& plant) {
  double out = 0;
  for (Index a = 0; a < plant.axis_count(); ++a) out += is_output(plant, a);
  return std::max(1.0, out);
}

/// Mean of a power density over the segments in equal bands of frequency.
class Bands {
 public:
  Bands(double low_hz, double high_hz, Index bins)
      : low_hz_(low_hz),
        high_hz_(high_hz),
        count_(std::clamp<Index>(bins, 1, kBands)),
        sum_(VectorXd::Zero(count_)),
        number_(VectorXd::Zero(count_)) {}

  void add(const RecordSegment& s, Index bin, double power) {
    const double hz = s.w[bin] / (2 * M_PI);
    const double share = (hz - low_hz_) / std::max(high_hz_ - low_hz_, 1e-300);
    const Index band =
        std::clamp<Index>(static_cast<Index>(share * static_cast<double>(count_)), 0, count_ - 1);
    sum_[band] += 2 * power / (s.rate_hz * static_cast<double>(s.intervals()));
    ++number_[band];
  }
  VectorXd amplitude() const { return (sum_.array() / number_.array().max(1)).sqrt(); }
  VectorXd middles() const {
    const double half = (high_hz_ - low_hz_) / (2 * static_cast<double>(count_));
    return VectorXd::LinSpaced(count_, low_hz_ + half, high_hz_ - half);
  }

 private:
  double low_hz_, high_hz_;
  Index count_;
  VectorXd sum_, number_;
};

/// Returns the power over that of noise in a bin, sum over the output axes.
double over_noise(const Plant& plant, const Gap& gap, Index bin) {
  double out = 0;
  for (Index a = 0; a < plant.axis_count(); ++a)
    if (is_output(plant, a) && gap.noise(a, bin) > 0)
      out += std::norm(gap.difference(a, bin)) / gap.noise(a, bin);
  return out;
}

struct Correlated {
  VectorXd value;
  double level = 0;
};

Correlated correlated(const Plant& plant, const std::vector<RecordSegment>& segments,
                      const std::vector<Gap>& gaps, std::size_t from, Index lags) {
  Correlated out{VectorXd::Zero(lags), 0};
  double total = 0, bins = 0;
  for (std::size_t r = from; r < segments.size(); ++r) {
    const Index count = segments[r].bins();
    for (Index b = 0; b < count; ++b) {
      const double power = over_noise(plant, gaps[r], b);
      total += power;
      const double step = M_PI * (static_cast<double>(b) + 0.5) / static_cast<double>(count);
      for (Index k = 0; k < lags; ++k)
        out.value[k] += power * std::cos(step * static_cast<double>(k + 1));
    }
    bins += static_cast<double>(count);
  }
  out.value /= std::max(total, 1e-300);
  out.level = std::sqrt(total / (std::max(bins, 1.0) * outputs_of(plant)));
  return out;
}

int outside(const VectorXd& value, double band) {
  return static_cast<int>((value.array().abs() > band).count());
}

}  // namespace

ResidualSpectrum residual_spectrum(const Plant& plant, const std::vector<RecordSegment>& segments,
                                   const std::vector<Gap>& before, const std::vector<Gap>& after,
                                   std::size_t from) {
  if (from >= segments.size() || !is_whole(segments, before)) return {};
  const bool has_after = is_whole(segments, after);
  const VectorXd& w = segments[from].w;
  const double low = w[0] / (2 * M_PI), high = w[w.size() - 1] / (2 * M_PI);
  Index fewest = w.size();
  for (std::size_t r = from; r < segments.size(); ++r)
    fewest = std::min(fewest, segments[r].bins());
  const Bands none(low, high, fewest);
  Bands measured = none, left = none, left_after = none, noise = none;
  const double outputs = outputs_of(plant);
  for (std::size_t r = from; r < segments.size(); ++r)
    for (Index b = 0; b < segments[r].bins(); ++b) {
      double of[4] = {0, 0, 0, 0};
      for (Index a = 0; a < plant.axis_count(); ++a) {
        if (!is_output(plant, a)) continue;
        of[0] += measured_power(segments[r], a, b);
        of[1] += std::norm(before[r].difference(a, b));
        if (has_after) of[2] += std::norm(after[r].difference(a, b));
        of[3] += before[r].noise(a, b);
      }
      measured.add(segments[r], b, of[0] / outputs);
      left.add(segments[r], b, of[1] / outputs);
      left_after.add(segments[r], b, of[2] / outputs);
      noise.add(segments[r], b, of[3] / outputs);
    }
  return {none.middles(), measured.amplitude(), left.amplitude(),
          has_after ? left_after.amplitude() : VectorXd(), noise.amplitude()};
}

std::vector<FloorGap> floor_gaps(const Plant& plant, const std::vector<RecordSegment>& segments,
                                 const std::vector<Gap>& before, const std::vector<Gap>& after,
                                 std::size_t from) {
  std::vector<FloorGap> out;
  if (from >= segments.size() || !is_whole(segments, before)) return out;
  const bool has_after = is_whole(segments, after);
  const auto records = static_cast<double>(segments.size() - from);
  for (int story = 1; story <= plant.structure.stories; ++story) {
    FloorGap one{story};
    bool any = false;
    for (std::size_t r = from; r < segments.size(); ++r) {
      double power = 0, of_before = 0, of_after = 0, of_noise = 0;
      for (Index a = 0; a < plant.axis_count(); ++a) {
        if (!is_output(plant, a) || plant.axes[static_cast<std::size_t>(a)].story != story)
          continue;
        any = true;
        for (Index b = 0; b < segments[r].bins(); ++b) power += measured_power(segments[r], a, b);
        of_before += before[r].difference.row(a).squaredNorm();
        if (has_after) of_after += after[r].difference.row(a).squaredNorm();
        of_noise += before[r].noise.row(a).sum();
      }
      const auto share = [&](double part) {
        return std::sqrt(part / std::max(power, 1e-300)) / records;
      };
      one.before += share(of_before);
      one.after += share(of_after);
      one.floor += share(of_noise);
    }
    if (!has_after) one.after = std::numeric_limits<double>::quiet_NaN();
    if (any) out.push_back(one);
  }
  return out;
}

ResidualCorrelation residual_correlation(const Plant& plant,
                                         const std::vector<RecordSegment>& segments,
                                         const std::vector<Gap>& before,
                                         const std::vector<Gap>& after, std::size_t from) {
  ResidualCorrelation out;
  if (from >= segments.size() || !is_whole(segments, before)) return out;
  Index fewest = segments[from].bins(), all = 0;
  for (std::size_t r = from; r < segments.size(); ++r) {
    fewest = std::min(fewest, segments[r].bins());
    all += segments[r].bins();
  }
  const Index lags = std::min(kLags, fewest / kBinsPerLag);
  if (lags < 1) return out;
  const RecordSegment& first = segments[from];
  const double width_hz =
      static_cast<double>(first.bins()) * first.rate_hz / static_cast<double>(first.intervals());
  out.lag_s = VectorXd::LinSpaced(lags, 1, static_cast<double>(lags)) / (2 * width_hz);
  out.white_band = kWithin / std::sqrt(2 * static_cast<double>(all));
  const Correlated left = correlated(plant, segments, before, from, lags);
  out.before = left.value;
  out.before_level = left.level;
  out.before_outside = outside(left.value, out.white_band);
  if (!is_whole(segments, after)) return out;
  const Correlated rest = correlated(plant, segments, after, from, lags);
  out.after = rest.value;
  out.after_level = rest.level;
  out.after_outside = outside(rest.value, out.white_band);
  return out;
}

bool is_patterned(int outside, Index lags) {
  const auto n = static_cast<double>(lags);
  return outside > kOutside * n + 2 * std::sqrt(n * kOutside * (1 - kOutside));
}

}  // namespace framewatch::estimator
