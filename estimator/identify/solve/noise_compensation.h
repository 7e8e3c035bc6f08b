// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <vector>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/gram/sliding_gram.h"
#include "estimator/identify/regressors/row_tuning.h"

namespace framewatch::estimator {

/// The expected contribution of sensor noise to the window's normal equations, W and w of
/// docs/equations.md (15), (16), and the part of it that the solver subtracts.
class NoiseCompensation {
 public:
  /// share: the part of the noise to subtract. With a share other than kCompensatedShare, every
  /// update() packs it anew, which takes time.
  explicit NoiseCompensation(const FloorLayout& layout, double share = kCompensatedShare);

  /// Updates to the rows of a window. level: variance of the actual noise over the variance that
  /// the tuning assumes.
  void update(const RowFilter& rows, const WindowParts& sums, double level);

  /// Keeps this share of a floor's instants, 0..1.
  void keep(int floor, double share) { floor_[static_cast<std::size_t>(floor)].instants *= share; }

  /// Stands for values[i] * scale.
  struct Part {
    const double* values;
    double scale;
  };
  /// Returns the part of a floor's sums that is subtracted, packed like them.
  Part compensation(int floor) const {
    const Floor& f = floor_[static_cast<std::size_t>(floor)];
    return {(f.packed.empty() ? f.rows->noise_compensation : f.packed).data(), level_ * f.instants};
  }
  /// Returns the effect that the remaining share of W has, with the errors of PerturbedDesigns, on
  /// a floor's equations: front unknowns x PerturbedDesigns::kCount.
  Part bias(int floor) const {
    const Floor& f = floor_[static_cast<std::size_t>(floor)];
    if (f.rows == nullptr) return {nullptr, 0};
    return {f.rows->noise_bias.data(), f.instants * remaining_share()};
  }

  /// Returns the diagonal of W, internal order: the energy of each regressor that comes from noise.
  const std::vector<double>& energy() const { return energy_; }
  /// Returns the share of W that remains in the matrix.
  double remaining_share() const { return level_ > 0 ? 1 - share_ : 1; }
  /// Returns the weighted residual energy that noise alone would leave.
  double residual() const { return residual_; }
  double residual(int floor) const {
    const Floor& f = floor_[static_cast<std::size_t>(floor)];
    return f.rows == nullptr ? 0 : f.instants * f.rows->noise_residual;
  }

  /// rows: the filter that formed the rows.
  void archive(auto& a, const RowFilter& rows) {
    for (std::size_t f = 0; f < floor_.size(); ++f) {
      std::uint8_t origin = rows.origin_of(static_cast<int>(f), floor_[f].rows);
      a(origin);
      a.finite(floor_[f].instants, floor_[f].packed);
      floor_[f].rows = rows.floor_rows_from(static_cast<int>(f), origin);
    }
    a.finite(energy_, residual_, level_);
  }
  /// Returns true after the first update().
  bool known() const {
    return std::all_of(floor_.begin(), floor_.end(), [](const Floor& f) { return f.rows; });
  }

 private:
  struct Floor {
    const FloorRows* rows = nullptr;
    double instants = 0;
    std::vector<double> packed;  ///< subtracted values if the share is not kCompensatedShare
  };
  FloorLayout layout_;
  double share_;
  std::vector<Floor> floor_;
  std::vector<double> energy_;
  double residual_ = 0;
  double level_ = 0;
};

/// The model's error: what the equations of a window leave beyond sensor noise. docs/equations.md,
/// errors of the model.
class ModelMisfit {
 public:
  explicit ModelMisfit(const FloorLayout& layout);

  /// Updates to a window, and learns how much a window usually leaves. solution: internal order.
  /// noise_known: the noise has the level that the tuning assumes; otherwise the whole residual
  /// counts as model error.
  void update(const WindowParts& sums, const std::vector<double>& solution,
              const NoiseCompensation& noise, bool noise_known);

  /// Returns the rms of what is left over the rms of the stiffness forces, the largest of the
  /// floors whose equations hold the unknown. NaN without forces.
  double misfit(int unknown) const;
  /// Returns the relative error of the unknown that the misfit may cause, one standard deviation.
  /// variance: the unknown's entry in the inverse of the normal matrix.
  double error(int unknown, double variance) const;
  /// Returns the part of that error which is new: from what is left beyond kJump times the usual.
  /// The model of a building is as wrong as ever in every window, so that a change is seen beside
  /// it. A failing sensor or a change within the window leaves more.
  /// usual: has learned what is usual, this object or that of another window.
  double new_error(int unknown, double variance, const ModelMisfit& usual) const;

  void archive(auto& a) {
    a.finite(excess_, force_);
    if (a.since(18)) {
      a.finite(usual_, least_);
      a.each_within(learned_, 0, kLearned);
    }
  }

 private:
  /// Ratio of energies: twice the usual amplitude.
  static constexpr double kJump = 4;
  /// Part of the noise's energy by which it may exceed what is expected: a quarter of its level.
  static constexpr double kNoiseDoubt = 0.5;
  /// Windows in the mean of what is usual: a minute of blocks. An earthquake is rarely longer, so
  /// its strong phase is not judged by its weak beginning.
  static constexpr int kLearned = 240;
  int lowest_floor(int unknown) const;
  void learn(std::size_t floor, double expected);
  /// Returns the ratio of excess to force beyond which a misfit is new, given the usual ratio.
  double limit(std::size_t floor, double usual) const {
    return kJump * usual + kNoiseDoubt * least_[floor];
  }
  double error_of(double excess, double variance) const;

  FloorLayout layout_;
  std::vector<double> excess_, force_;  ///< by floor, energies in the units of the rows
  std::vector<double> usual_;           ///< by floor: mean of excess over force
  std::vector<double> least_;           ///< by floor: share of the force that noise may leave
  std::vector<int> learned_;            ///< by floor: windows in the mean
  std::vector<double> x_, stiff_;
};

}  // namespace framewatch::estimator
