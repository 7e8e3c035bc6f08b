#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace framewatch::fleet {

/// A parameter over several periods.
struct Level {
  double value = 0;      ///< median of the periods' medians
  double std_error = 0;  ///< of the value
  int periods = 0;       ///< 0: it was observable in none
};
/// Of periods in which it was observable: their medians, and root mean squares of their windows'
/// own standard errors, of equal length. std_error is sqrt(pi / 2) s / sqrt(periods), the standard
/// error of a median, where s is the larger of the root mean square of `std_errors` and 1.4826
/// times the median absolute deviation of the medians: a period counts as one window, since windows
/// overlap and what slowly varies (temperature, tuning) is common to them.
Level level_of(std::span<const float> medians, std::span<const float> std_errors);

/// The same parameter before and after.
struct Comparison {
  std::string name, unit;
  Level before, after;
  double ratio = 0;      ///< after / before - 1; negative: a loss
  double std_error = 0;  ///< of the ratio
  bool compared = false;
  bool told =
      false;  ///< the building's own record of the change: ratio and std_error are that one's
  /// compared: the ratio in standard errors; negative for a loss.
  double times_error() const { return std_error > 0 ? ratio / std_error : 0; }
};
void compare(Comparison& both);

/// How many standard errors make a difference significant among so many comparisons: a one-sided
/// normal quantile at which by chance one such list in twenty has a loss at all
/// (Bonferroni: 0.05 / comparisons).
double significant_errors(std::size_t comparisons);

}  // namespace framewatch::fleet
