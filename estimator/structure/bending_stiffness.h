#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace framewatch::estimator {

/// Rotational stiffness of every frame along x and along y where it stands on its base, N*m/rad;
/// 0: frames do not bend. shares: that of its floors, base first, relative to the base's; empty: of
/// every floor alike (effect frame_bending).
struct BendingStiffness {
  std::array<double, 2> base_nmprad{};
  std::array<std::vector<double>, 2> shares{};

  double operator[](std::size_t direction) const { return base_nmprad[direction]; }
  bool any() const { return base_nmprad[0] > 0 || base_nmprad[1] > 0; }
  /// floor: 0 (base) to the one below the roof.
  double of_floor(std::size_t direction, std::size_t floor) const {
    const std::vector<double>& share = shares[direction];
    return base_nmprad[direction] * (share.empty() ? 1 : share[floor]);
  }
};

}  // namespace framewatch::estimator
