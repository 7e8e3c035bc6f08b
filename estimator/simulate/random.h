#pragma once

#include <cstdint>
#include <random>

namespace framewatch::estimator {

/// Seeded normal and uniform numbers; unlike the standard distributions the same everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// A generator of its own for every (seed, stream).
  Random(std::uint64_t seed, std::uint64_t stream);

  /// In [0, 1).
  double uniform();
  /// Mean 0, standard deviation 1 (Box-Muller).
  double normal();

 private:
  std::mt19937_64 engine_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace framewatch::estimator
