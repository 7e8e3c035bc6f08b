#pragma once

#include <algorithm>
#include <vector>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/regressors/row_tuning.h"

namespace framewatch::estimator {

/// What sensor noise is expected to have added to the window's normal equations, W and w of
/// docs/equations.md (15), (16), and how much of it the solver subtracts.
class NoiseCompensation {
 public:
  /// share: of the noise that is subtracted. With another one than kCompensatedShare every update()
  /// packs it anew, which takes time.
  explicit NoiseCompensation(const FloorLayout& layout, double share = kCompensatedShare);

  /// level: variance of the noise that is there, divided by what the tuning assumes.
  void update(const RowFilter& rows, const WindowParts& sums, double level);

  /// Values times scale.
  struct Part {
    const double* values;
    double scale;
  };
  /// Part of a floor's sums that is subtracted, packed like them.
  Part compensation(int floor) const {
    const Floor& f = floor_[static_cast<std::size_t>(floor)];
    return {(f.packed.empty() ? f.rows->noise_compensation : f.packed).data(), level_ * f.instants};
  }
  /// What the remaining share of W makes of the errors of the PerturbedDesigns in a floor's
  /// equations: front unknowns x PerturbedDesigns::kCount.
  Part bias(int floor) const {
    const Floor& f = floor_[static_cast<std::size_t>(floor)];
    if (f.rows == nullptr) return {nullptr, 0};
    return {f.rows->noise_bias.data(), f.instants * remaining_share()};
  }

  /// W's diagonal, internal order: energy each regressor has from noise.
  const std::vector<double>& energy() const { return energy_; }
  /// Share of W that remains in the matrix.
  double remaining_share() const { return level_ > 0 ? 1 - share_ : 1; }
  /// Expected weighted residual energy from noise alone.
  double residual() const { return residual_; }
  double residual(int floor) const {
    const Floor& f = floor_[static_cast<std::size_t>(floor)];
    return f.rows == nullptr ? 0 : f.instants * f.rows->noise_residual;
  }

  /// rows: the filter that formed the rows.
  template <typename Archive>
  void archive(Archive& a, const RowFilter& rows) {
    for (std::size_t f = 0; f < floor_.size(); ++f) {
      std::uint8_t origin = rows.origin_of(static_cast<int>(f), floor_[f].rows);
      a(origin);
      a.finite(floor_[f].instants, floor_[f].packed);
      floor_[f].rows = rows.floor_rows_from(static_cast<int>(f), origin);
    }
    a.finite(energy_, residual_, level_);
  }
  /// It has been updated.
  bool known() const {
    return std::all_of(floor_.begin(), floor_.end(), [](const Floor& f) { return f.rows; });
  }

 private:
  struct Floor {
    const FloorRows* rows = nullptr;
    double instants = 0;
    std::vector<double> packed;  ///< what is subtracted when that is not kCompensatedShare
  };
  FloorLayout layout_;
  double share_;
  std::vector<Floor> floor_;
  std::vector<double> energy_;
  double residual_ = 0;
  double level_ = 0;
};

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
