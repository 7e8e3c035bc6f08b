#pragma once

#include <vector>

#include "estimator/identify/floor_layout.h"
#include "estimator/identify/row_chain.h"
#include "estimator/identify/window_sums.h"

namespace framewatch {

/// What sensor noise is expected to have put into the window's normal equations, and how much of it
/// the solver takes off.
class NoiseShare {
 public:
  /// share: of the noise that is taken off. Another one than kTakenOff costs every update() the
  /// packing.
  explicit NoiseShare(const FloorLayout& layout, double share = kTakenOff);

  /// level: variance of the noise over the tuning's.
  void update(const RowChain& rows, const WindowParts& sums, double level);

  /// Values times scale.
  struct Part {
    const double* values;
    double scale;
  };
  /// Part of a floor's sums that is taken off, packed like them.
  Part taken_off(int floor) const {
    const Floor& f = floor_[static_cast<std::size_t>(floor)];
    return {(f.packed.empty() ? f.rows->noise_taken_off : f.packed).data(), level_ * f.instants};
  }
  /// Pull of what is left of W in a floor's equations toward the wrong designs: front unknowns x
  /// WrongDesigns::kCount.
  Part pull(int floor) const {
    const Floor& f = floor_[static_cast<std::size_t>(floor)];
    if (f.rows == nullptr) return {nullptr, 0};
    return {f.rows->noise_pull.data(), f.instants * left_share()};
  }

  /// W's diagonal, internal order: energy each regressor has from noise.
  const std::vector<double>& energy() const { return energy_; }
  /// Share of W that is left in the matrix.
  double left_share() const { return level_ > 0 ? 1 - share_ : 1; }
  /// Expected weighted residual energy from noise alone.
  double residual() const { return residual_; }

  /// rows: of the chain whose rows it speaks of.
  template <typename Archive>
  void archive(Archive& a, const RowChain& rows) {
    for (std::size_t f = 0; f < floor_.size(); ++f) {
      std::uint8_t origin = rows.origin_of(static_cast<int>(f), floor_[f].rows);
      a(origin, floor_[f].instants, floor_[f].packed);
      floor_[f].rows = rows.floor_rows_from(static_cast<int>(f), origin);
    }
    a(energy_, residual_, level_);
  }

 private:
  struct Floor {
    const FloorRows* rows = nullptr;
    double instants = 0;
    std::vector<double> packed;  ///< what is taken off when that is not kTakenOff
  };
  FloorLayout layout_;
  double share_;
  std::vector<Floor> floor_;
  std::vector<double> energy_;
  double residual_ = 0;
  double level_ = 0;
};

}  // namespace framewatch
