#include "estimator/identify/elements/perturbed_designs.h"

#include <cstdint>

#include "estimator/structure/parameter_table.h"

namespace framewatch::estimator {
namespace {

/// Standard deviation of a design that is off by anything up to its tolerance, over the tolerance.
constexpr double kUniform = 0.58;

/// A fixed random sign: the same on every run and machine (splitmix64).
double sign(int row, int column) {
  std::uint64_t z = (static_cast<std::uint64_t>(row) << 20) + static_cast<std::uint64_t>(column);
  z += 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return ((z ^ (z >> 31)) & 1) != 0 ? 1.0 : -1.0;
}

}  // namespace

PerturbedDesigns::PerturbedDesigns(const FloorLayout& layout) : own_(layout.own()) {
  for (int u = 0; u < layout.unknowns(); ++u)
    for (int c = 0; c < kCount; ++c)
      error_.push_back(kUniform * design_tolerance(layout.kind(u % own_)) * sign(u, c));
}

}  // namespace framewatch::estimator
