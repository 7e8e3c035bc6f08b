#pragma once

#include <vector>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/solve/noise_compensation.h"

namespace framewatch::estimator {

/// What the equations of a window leave beyond what sensor noise explains: the model's error.
/// docs/equations.md, errors of the model.
class ModelMisfit {
 public:
  explicit ModelMisfit(const FloorLayout& layout);

  /// solution: of the window, internal order. noise_known: its level is what the tuning assumes;
  /// otherwise all that is left counts.
  void update(const WindowParts& sums, const std::vector<double>& solution,
              const NoiseCompensation& noise, bool noise_known);

  /// Of the floors whose equations hold the unknown, the largest: rms of what is left over the rms
  /// of the stiffness forces. NaN: no forces.
  double misfit(int unknown) const;
  /// Relative error that the model's misfit may make of the unknown, one standard deviation.
  /// variance: the unknown's entry in the inverse of the normal matrix.
  double error(int unknown, double variance) const;

  template <typename Archive>
  void archive(Archive& a) {
    a.finite(excess_, force_);
  }

 private:
  int lowest_floor(int unknown) const;

  FloorLayout layout_;
  std::vector<double> excess_, force_;  ///< by floor, energies in the rows' units
  std::vector<double> x_, stiff_;
};

}  // namespace framewatch::estimator
