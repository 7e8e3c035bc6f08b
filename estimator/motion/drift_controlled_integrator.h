// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "estimator/motion/derivative_triple.h"

namespace framewatch::estimator {

/// A second-order Butterworth high-pass (bilinear) that removes a sensor's bias, thermal ramp and
/// tilt. It starts as if the first sample of an axis had always been there, so there is no start
/// step. docs/equations.md (9).
struct HighPass {
  HighPass(double corner_hz, double rate_hz);
  double gain, a1, a2;
};

/// The part of the drift-controlled integrator that all rows of the regression share: for every
/// axis a high-pass against drift, then p, p' and p'' by one triple of short filters. The
/// oscillator section of each row (OscillatorSection, applied by RegressorFilter at the row's
/// corner) turns them into displacement, velocity and acceleration. All three pass the same
/// filters, so the equation of motion still holds between them.
/// docs/equations.md, the drift-controlled integrator.
///
/// An axis without a value is invalid until its filters have been refilled.
class DriftControlledIntegrator {
 public:
  /// triples: one per axis, all of the same length and delay.
  DriftControlledIntegrator(const std::vector<DerivativeTriple>& triples,
                            const HighPass& high_pass);

  /// Takes one value per axis, m/s^2; NaN if it is missing.
  void push(const std::vector<double>& accel);
  void reset();

  bool valid(int axis) const { return filled_[index(axis)] >= static_cast<int>(length_); }
  /// Return p, p' and p'' of the axis at the last push, m/s^2, m/s^3, m/s^4; 0 while the axis is
  /// invalid.
  double value(int axis) const { return value_[index(axis)]; }
  double first(int axis) const { return first_[index(axis)]; }
  double second(int axis) const { return second_[index(axis)]; }
  /// Return the outputs of DerivativeTriple::held_first and held_second, if the triples have them.
  double held_first(int axis) const { return held_first_[index(axis)]; }
  double held_second(int axis) const { return held_second_[index(axis)]; }

  void archive(auto& a) {
    a.within(newest_, 0, static_cast<double>(length_ - 1));
    a.each_within(filled_, 0, static_cast<double>(length_));
    a.finite(x1_, x2_, y1_, y2_, ring_, value_, first_, second_, held_first_, held_second_);
  }

 private:
  static std::size_t index(int axis) { return static_cast<std::size_t>(axis); }
  void push_axis(std::size_t axis, double accel);

  HighPass high_pass_;
  std::size_t axes_;
  std::size_t length_;
  int outputs_;               ///< 3 or 5, padded to whole lanes
  std::vector<double> taps_;  ///< axes x length x outputs
  std::size_t newest_ = 0;
  std::vector<double> x1_, x2_, y1_, y2_;
  std::vector<int> filled_;   ///< samples since the axis (re)started, saturating
  std::vector<double> ring_;  ///< axes x 2 length, mirrored, newest first from newest_
  std::vector<double> value_, first_, second_, held_first_, held_second_;
};

}  // namespace framewatch::estimator
