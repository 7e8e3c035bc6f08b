// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/motion/drift_controlled_integrator.h"
#include "estimator/structure/sensors.h"

namespace framewatch::estimator {

/// The motion of the whole building at one instant, from which regression rows are formed.
struct DeformationSet {
  std::vector<double> values;       ///< in the order that the MotionSource defines
  std::vector<std::uint8_t> known;  ///< flags of the measured places, in the same order

  void archive(auto& a) {
    a.finite(values);
    a.each_within(known, 0, 1);
  }
};

/// Turns the filtered motion of the axes into the motion that rows are formed from.
class MotionSource {
 public:
  virtual ~MotionSource() = default;
  virtual void compute(const DriftControlledIntegrator& motion, DeformationSet& set) const = 0;
  virtual DeformationSet make_set() const = 0;
};

/// Turns the filtered motion of the axes into element deformations. Each floor has stride() values:
/// p of the frames, p' of the frames, p of the panels, p' of the panels, then mass times the
/// absolute p'' of the frames. A frame's deformation is the absolute motion of its upper end minus
/// that of its lower end; a panel's is its shear. The first own() values follow FloorLayout. There
/// is one flag per (floor 0..N, frame): its motion is known. Floor 0 is the base.
class Deformations : public MotionSource {
 public:
  Deformations(const Structure& structure, const FloorLayout& layout,
               const std::vector<SensorAxis>& axes);

  int stride() const { return layout_->own() + layout_->frames(); }
  int floors() const { return layout_->floors(); }
  void compute(const DriftControlledIntegrator& motion, DeformationSet& set) const override;
  DeformationSet make_set() const override;

  /// The share of an axis in the motion of a place.
  struct Weighted {
    int axis;
    double weight;
  };
  /// Returns the axes that give the motion at (floor 0..N, frame); empty if no sensor does.
  const std::vector<Weighted>& at(int floor, int frame) const {
    return place_[static_cast<std::size_t>(floor * layout_->frames() + frame)];
  }
  /// Returns the configured noise of every axis, m/s^2/sqrt(Hz), or kDefaultNoiseDensity where it
  /// is not configured.
  const std::vector<double>& noise_density() const { return noise_density_; }

 private:
  const FloorLayout* layout_;
  std::vector<std::vector<Weighted>> place_;  ///< axes that give the motion at a place
  std::vector<double> noise_density_;
  std::vector<double> mass_;
  struct Panel {
    int u0, u1, v0, v1;
    double bu, bv;
  };
  std::vector<Panel> panels_;
};

/// Returns the variance of one sample of white sensor noise, (m/s^2)^2, of a one-sided density,
/// m/s^2/sqrt(Hz).
inline double noise_variance(double density, double rate_hz) {
  return density * density * rate_hz / 2;
}

/// The filtered motion of every axis, unchanged: kSignals values and one flag per axis.
class AxisMotion : public MotionSource {
 public:
  /// Signals per axis: p, p', p'', and p', p'' for the inputs of a simulation (held_triple).
  static constexpr int kSignals = 5;
  enum Signal { value, first, second, held_first, held_second };

  explicit AxisMotion(int axes) : axes_(axes) {}
  void compute(const DriftControlledIntegrator& motion, DeformationSet& set) const override;
  DeformationSet make_set() const override;

 private:
  int axes_;
};

}  // namespace framewatch::estimator
