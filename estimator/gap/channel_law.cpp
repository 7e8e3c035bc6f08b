// SPDX-License-Identifier: MIT
#include "estimator/gap/channel_law.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace framewatch::estimator {
namespace {

using Column = Eigen::VectorXd;

constexpr double kHalved = 0.5;     ///< a law with one more number must leave at most this share
constexpr double kLatest_s = 0.25;  ///< longest delay searched
constexpr double kStart = 0.2;      ///< share of the window in which a low-pass forgets its start

/// Pairs of a reading and the motion it should show: one for an axis, several for an input.
struct Pairs {
  std::vector<Column> read, expected;

  template <typename Left>
  double sum(const Left& left) const {
    double out = 0;
    for (std::size_t i = 0; i < read.size(); ++i) out += left(read[i], expected[i]);
    return out;
  }
};

void take_better(ChannelLaw& best, double share, ChannelFault fault, double value, double left) {
  if (!(left < share * best.left)) return;
  best.fault = fault, best.value = value, best.left = left;
}

double left_of(const Column& read, const Column& expected) {
  return (read - expected).squaredNorm();
}

ChannelLaw gain_law(const Pairs& pairs) {
  const double both = pairs.sum([](const auto& r, const auto& e) { return r.dot(e); });
  const double energy = pairs.sum([](const auto&, const auto& e) { return e.squaredNorm(); });
  ChannelLaw law;
  law.value = both / energy;
  law.fault = law.value < 0 ? ChannelFault::polarity : ChannelFault::gain;
  law.left = pairs.sum([&](const auto& r, const auto& e) { return left_of(r, law.value * e); });
  return law;
}

/// Finds the whole shift at which the readings fit best, then its remainder and drift by the slope
/// of the motion: r(i) = e(i - shift - rest - drift * i).
void add_times(const Pairs& pairs, double rate_hz, ChannelLaw& best) {
  const Eigen::Index most = std::lround(kLatest_s * rate_hz);
  const Eigen::Index inner = pairs.read.front().size() - 2 * most - 2;
  if (inner < most) return;
  const Eigen::Index from = most + 1;
  const auto left_at = [&](Eigen::Index shift) {
    return pairs.sum([&](const Column& r, const Column& e) {
      return (r.segment(from, inner) - e.segment(from - shift, inner)).squaredNorm();
    });
  };
  Eigen::Index shift = 0;
  double least = left_at(0);
  const double whole = pairs.sum(left_of) / least;
  for (Eigen::Index s = -most; s <= most; ++s)
    if (const double left = left_at(s); left < least) least = left, shift = s;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();  // slope, slope times time
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  const Column time = Column::LinSpaced(inner, -1, 1);
  double energy = 0;
  for (std::size_t i = 0; i < pairs.read.size(); ++i) {
    const Column& e = pairs.expected[i];
    const Column slope =
        -0.5 * (e.segment(from - shift + 1, inner) - e.segment(from - shift - 1, inner));
    const Column rest = pairs.read[i].segment(from, inner) - e.segment(from - shift, inner);
    const Column turned = slope.cwiseProduct(time);
    normal(0, 0) += slope.squaredNorm();
    normal(0, 1) += slope.dot(turned);
    normal(1, 1) += turned.squaredNorm();
    right += Eigen::Vector2d(slope.dot(rest), turned.dot(rest));
    energy += rest.squaredNorm();
  }
  const double rest = right[0] / normal(0, 0);
  take_better(best, 1, ChannelFault::late, (static_cast<double>(shift) + rest) / rate_hz,
              whole * (energy - rest * right[0]));
  const double determinant = normal(0, 0) * normal(1, 1) - normal(0, 1) * normal(0, 1);
  const Eigen::Vector2d both = Eigen::Vector2d(normal(1, 1) * right[0] - normal(0, 1) * right[1],
                                               normal(0, 0) * right[1] - normal(0, 1) * right[0]) /
                               determinant;
  take_better(best, best.fault == ChannelFault::late ? kHalved : 1, ChannelFault::clock,
              2 * both[1] / static_cast<double>(inner), whole * (energy - both.dot(right)));
}

Column low_passed(const Column& in, double corner_hz, double rate_hz) {
  const double share = 1 - std::exp(-2 * std::numbers::pi * corner_hz / rate_hz);
  Column out(in.size());
  double state = in[0];
  for (Eigen::Index i = 0; i < in.size(); ++i) out[i] = state += share * (in[i] - state);
  return out;
}

/// Adds low-passes of one and two poles.
void add_bandwidths(const Pairs& pairs, double rate_hz, ChannelLaw& best) {
  const Eigen::Index rows = pairs.read.front().size();
  const Eigen::Index kept = rows - static_cast<Eigen::Index>(kStart * static_cast<double>(rows));
  const double scale = pairs.sum(left_of) / pairs.sum([&](const Column& r, const Column& e) {
    return (r - e).tail(kept).squaredNorm();
  });
  if (!std::isfinite(scale)) return;
  for (double corner_hz = 0.4 * rate_hz; corner_hz > 0.3; corner_hz /= 1.25) {
    double once_left = 0, twice_left = 0;
    for (std::size_t i = 0; i < pairs.read.size(); ++i) {
      const Column& r = pairs.read[i];
      const Column once = low_passed(pairs.expected[i], corner_hz, rate_hz);
      once_left += (r - once).tail(kept).squaredNorm();
      twice_left += (r - low_passed(once, corner_hz, rate_hz)).tail(kept).squaredNorm();
    }
    take_better(best, 1, ChannelFault::bandwidth, corner_hz,
                std::min(once_left, twice_left) * scale);
  }
}

void add_saturation(const Pairs& pairs, ChannelLaw& best) {
  const double most = pairs.expected.front().cwiseAbs().maxCoeff();
  for (double level = 2 * most; level > 0.05 * most; level /= 1.1) {
    const auto soft = [&](const Column& r, const Column& e) {
      return left_of(r, level * (e / level).array().tanh().matrix());
    };
    const auto hard = [&](const Column& r, const Column& e) {
      return left_of(r, e.cwiseMax(-level).cwiseMin(level));
    };
    take_better(best, 1, ChannelFault::saturated, level,
                std::min(pairs.sum(soft), pairs.sum(hard)));
  }
}

bool known(const Eigen::MatrixXd& of, Eigen::Index axis) {
  return of.col(axis).allFinite();
}

/// Adds laws of two channels. Two that are exchanged both read the motion of the other.
void add_others(const ChannelReadings& of, Eigen::Index axis, ChannelLaw& best) {
  for (Eigen::Index other = 0; other < of.read.cols(); ++other) {
    if (other == axis || !known(of.read, other)) continue;
    const Column read = of.read.col(axis);
    if (const double left = left_of(read, of.read.col(other)); left < best.left) {
      best = {ChannelFault::repeats, 0, static_cast<int>(other), left};
    }
    if (!known(of.expected, other)) continue;
    const double left = left_of(read, of.expected.col(other));
    const double back = left_of(of.read.col(other), of.expected.col(axis));
    const double as_it_is = left_of(of.read.col(other), of.expected.col(other));
    if (left < best.left && back < kExplained * as_it_is)
      best = {ChannelFault::exchanged, 0, static_cast<int>(other), left};
  }
}

/// Returns true if the readings do not follow the motion at all and are small beside it.
bool is_noise(const Pairs& pairs) {
  constexpr double kSmall = 0.1, kNothing = 1e-4;  // of the energy
  const double energy = pairs.sum([](const auto& r, const auto&) { return r.squaredNorm(); });
  const double motion = pairs.sum([](const auto&, const auto& e) { return e.squaredNorm(); });
  return energy < kNothing * motion ||
         (energy < kSmall * motion && gain_law(pairs).left > (1 - kSmall) * energy);
}

/// Returns the law if it explains the readings. It must leave little beside both sides: a law that
/// makes one of them vanish explains nothing.
ChannelLaw explained(const Pairs& pairs, const ChannelLaw& best, double before) {
  const double all = pairs.sum([](const auto& r, const auto&) { return r.squaredNorm(); });
  const double motion = pairs.sum([](const auto&, const auto& e) { return e.squaredNorm(); });
  if (best.left <= kExplained * std::min({before, all, motion})) return best;
  return {ChannelFault::unlike, 0, -1, before};
}

}  // namespace

ChannelLaw law_of(const ChannelReadings& of, int axis) {
  const Pairs pairs{{of.read.col(axis)}, {of.expected.col(axis)}};
  const double before = pairs.sum(left_of);
  ChannelLaw best = gain_law(pairs);
  add_times(pairs, of.rate_hz, best);
  add_saturation(pairs, best);
  add_bandwidths(pairs, of.rate_hz, best);
  add_others(of, axis, best);
  if (is_noise(pairs)) return {ChannelFault::only_noise, 0, -1, before};
  return explained(pairs, best, before);
}

ChannelLaw law_of_input(const ChannelReadings& of) {
  Pairs pairs;
  for (Eigen::Index column = 0; column < of.read.cols(); ++column) {
    pairs.read.push_back(of.read.col(column));
    pairs.expected.push_back(of.expected.col(column));
  }
  const double before = pairs.sum(left_of);
  ChannelLaw best = gain_law(pairs);
  add_times(pairs, of.rate_hz, best);
  add_bandwidths(pairs, of.rate_hz, best);
  ChannelLaw law = explained(pairs, best, before);
  if (law.fault != ChannelFault::unlike)
    law.left *= of.expected.squaredNorm() / of.read.squaredNorm();
  return law;
}

}  // namespace framewatch::estimator
