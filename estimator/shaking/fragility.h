#pragma once

#include <array>
#include <cstddef>

namespace framewatch::estimator {

/// Damage states of a story's structure, as HAZUS names them.
enum class DamageState { slight, moderate, extensive, complete };
inline constexpr std::size_t kDamageStates = 4;

/// Story drift at which damage states begin: lognormal, by DamageState.
struct Fragility {
  std::array<double, kDamageStates> median{};      ///< drift over story height
  std::array<double, kDamageStates> dispersion{};  ///< standard deviation of the logarithm
};

/// Probabilities that a story is in a damage state or a worse one, by DamageState.
/// drift_ratio: its peak, > 0; std_error: its standard error, >= 0, which widens the dispersion.
/// A worse state is never more likely than a lighter one, whatever the dispersions are.
/// docs/equations.md (63). NaN when one of the arguments is.
std::array<double, kDamageStates> damage_probabilities(const Fragility& fragility,
                                                       double drift_ratio, double std_error);

}  // namespace framewatch::estimator
