#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fleet/store/database.h"

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

/// A building whose stiffnesses are compared.
struct ComparedBuilding {
  std::string name, title, place;
  int period_s = 0;           ///< 0: nothing of the time is there
  int before = 0, after = 0;  ///< periods
  std::vector<Comparison> stiffness;
};

/// Periods of one length, on both sides of a time.
struct ComparedTime {
  int period_s = 0;
  std::int64_t from_us = 0, until_us = 0;  ///< before: they begin and end within
  std::int64_t after_us = 0, to_us = 0;    ///< after: likewise
};

/// Reads summaries and compares them, some buildings at once, so that memory is bounded.
class PeriodReader {
 public:
  static constexpr std::size_t kAtOnce = 100;

  explicit PeriodReader(Database& database) : database_(database) {}

  /// Fills what is still without a period, where there are at least `least` periods before and
  /// after; buildings by their number in the database. False when the database does not answer.
  [[nodiscard]] bool read(std::map<std::int64_t, ComparedBuilding>& buildings,
                          const ComparedTime& time, int least);

 private:
  struct Names {
    std::vector<std::string> name, unit;
    std::vector<std::int32_t> kind;
  };
  /// Of these buildings, into names_; stiffnesses: the longest list up to its last one.
  bool read_names(const std::string& ids, std::size_t& stiffnesses);
  bool read_some(const std::vector<std::int64_t>& ids,
                 std::map<std::int64_t, ComparedBuilding>& buildings, const ComparedTime& time,
                 int least);

  Database& database_;
  std::map<std::pair<std::int64_t, std::string>, Names> names_;
};

}  // namespace framewatch::fleet
