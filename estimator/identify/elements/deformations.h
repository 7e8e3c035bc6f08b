#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/motion/drift_controlled_integrator.h"
#include "estimator/structure/sensors.h"

namespace framewatch::estimator {

/// Motion of the whole building at one instant as the regressor rows need it.
struct DeformationSet {
  std::vector<double> values;       ///< as the MotionSource says
  std::vector<std::uint8_t> known;  ///< flags of what is measured, likewise

  template <typename Archive>
  void archive(Archive& a) {
    a.finite(values);
    a.each_within(known, 0, 1);
  }
};

/// Turns filtered axis motion into what rows are formed of.
class MotionSource {
 public:
  virtual ~MotionSource() = default;
  virtual void compute(const DriftControlledIntegrator& motion, DeformationSet& set) const = 0;
  virtual DeformationSet make_set() const = 0;
};

/// Turns filtered axis motion into element deformations, floor by floor:
/// [p of the frames, p' of the frames, p of the panels, p' of the panels] as element deformations
/// (absolute motion of the upper end minus the lower, panels sheared), then mass times p'' of the
/// frames, absolute. stride() values per floor; the first own() of them follow FloorLayout. Flags:
/// one per (floor 0..N, frame), its motion is known; floor 0 is the base.
class Deformations : public MotionSource {
 public:
  Deformations(const Structure& structure, const FloorLayout& layout,
               const std::vector<SensorAxis>& axes);

  int stride() const { return layout_->own() + layout_->frames(); }
  int floors() const { return layout_->floors(); }
  void compute(const DriftControlledIntegrator& motion, DeformationSet& set) const override;
  DeformationSet make_set() const override;

  /// An axis' share in the motion of a place.
  struct Weighted {
    int axis;
    double weight;
  };
  /// The axes that give the motion at (floor 0..N, frame); empty when no sensor does.
  const std::vector<Weighted>& at(int floor, int frame) const {
    return place_[static_cast<std::size_t>(floor * layout_->frames() + frame)];
  }
  /// Configured noise of every axis, m/s^2/sqrt(Hz); kDefaultNoiseDensity where it is not.
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

/// Variance of one sample of white sensor noise, (m/s^2)^2; density one-sided, m/s^2/sqrt(Hz).
inline double noise_variance(double density, double rate_hz) {
  return density * density * rate_hz / 2;
}

/// The filtered motion of every axis as it is: kSignals values per axis, one flag each.
class AxisMotion : public MotionSource {
 public:
  /// p, p', p'', and p', p'' for the inputs of a simulation (held_triple).
  static constexpr int kSignals = 5;
  enum Signal { value, first, second, held_first, held_second };

  explicit AxisMotion(int axes) : axes_(axes) {}
  void compute(const DriftControlledIntegrator& motion, DeformationSet& set) const override;
  DeformationSet make_set() const override;

 private:
  int axes_;
};

}  // namespace framewatch::estimator
