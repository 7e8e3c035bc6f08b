#pragma once

#include <cstdint>

namespace framewatch::estimator {

/// A fixed random sign, 1 or -1: the same on every run and machine (splitmix64).
inline double fixed_sign(int row, int column) {
  std::uint64_t z = (static_cast<std::uint64_t>(row) << 20) + static_cast<std::uint64_t>(column);
  z += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return ((z ^ (z >> 31)) & 1) != 0 ? 1.0 : -1.0;
}

}  // namespace framewatch::estimator
