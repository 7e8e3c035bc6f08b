// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

namespace framewatch::estimator {

/// A law leaves at most this share of the energy of what it explains: half of the amplitude.
inline constexpr double kExplained = 0.25;

/// How a channel misreads.
enum class ChannelFault {
  unlike,      ///< its reading is not the building's motion, in no way named below
  gain,        ///< ChannelLaw::value times the motion
  polarity,    ///< the motion with the other sign, value times
  late,        ///< by value seconds; early if negative
  clock,       ///< its clock runs off by value parts of 1
  exchanged,   ///< with the channel ChannelLaw::other
  repeats,     ///< the reading of the channel ChannelLaw::other
  only_noise,  ///< it does not move with the building
  saturated,   ///< it never reads more than value, m/s^2
  bandwidth    ///< it follows the motion only below value, Hz
};

/// The fault that explains a reading best.
struct ChannelLaw {
  ChannelFault fault = ChannelFault::unlike;  ///< unlike if none explains it
  double value = 0;                           ///< see ChannelFault; 0 if it has no number
  int other = -1;                             ///< see ChannelFault; -1: no channel
  double left = 0;  ///< energy of the reading that the law leaves, (m/s^2)^2 x instants

  /// Archives the state, as every archive() does: estimator/state/archive.h.
  void archive(auto& a) {
    a.within(fault, 0, static_cast<double>(ChannelFault::bandwidth));
    a.finite(value, left);
    a.within(other, -1, 1e6);
  }
};

/// Readings beside what they should be: instants x axes, m/s^2. A column of `expected` that is not
/// finite is not known.
struct ChannelReadings {
  Eigen::MatrixXd read;
  Eigen::MatrixXd expected;
  double rate_hz;
};

/// Returns the law of one axis, docs/equations.md, faults of channels. A law with a further number
/// must halve what is left, and any law must leave at most a quarter of `read - expected`.
ChannelLaw law_of(const ChannelReadings& readings, int axis);
/// Returns the law of an input of a linear model: gain, polarity, late, clock, bandwidth or unlike.
/// A linear model and these laws commute, so the motion that an input causes shows them like the
/// input itself. readings.read: by floor, the motion that the input's reading causes; expected: the
/// motion that the true input must cause. ChannelLaw::left is of `expected`.
ChannelLaw law_of_input(const ChannelReadings& readings);

}  // namespace framewatch::estimator
