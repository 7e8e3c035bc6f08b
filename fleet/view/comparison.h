// SPDX-License-Identifier: MIT
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

/// The value of a parameter over several periods.
struct Level {
  double value = 0;      ///< median of the periods' medians
  double std_error = 0;  ///< of the value
  int periods = 0;       ///< 0: not observable in any period
};
/// Combines periods of equal length in which a parameter was observable. medians: of each period.
/// std_errors: root mean square of the windows' standard errors of each period. The result's
/// std_error is sqrt(pi / 2) s / sqrt(periods), the standard error of a median, where s is the
/// larger of the root mean square of `std_errors` and 1.4826 times the median absolute deviation of
/// the medians. A period counts as one window, because its windows overlap and share slow variation
/// (temperature, tuning).
Level level_of(std::span<const float> medians, std::span<const float> std_errors);

/// One parameter before and after a time.
struct Comparison {
  std::string name, unit;
  Level before, after;
  double ratio = 0;      ///< after / before - 1; negative: a loss
  double std_error = 0;  ///< of the ratio
  bool compared = false;
  /// The building recorded the change; ratio and std_error are those of its record.
  bool told = false;
  /// Returns the ratio in standard errors, negative for a loss; 0 if not compared.
  double times_error() const { return std_error > 0 ? ratio / std_error : 0; }
};
void compare(Comparison& both);

/// Returns how many standard errors make a loss significant among `comparisons`: the one-sided
/// normal quantile of 0.05 / comparisons (Bonferroni), at which one list in twenty has any loss by
/// chance.
double significant_errors(std::size_t comparisons);

/// A building whose stiffnesses are compared.
struct ComparedBuilding {
  std::string name, title, place;
  int period_s = 0;           ///< 0: no periods found
  int before = 0, after = 0;  ///< number of periods
  std::vector<Comparison> stiffness;
};

/// Periods of one length, on both sides of a time.
struct ComparedTime {
  int period_s = 0;
  std::int64_t from_us = 0, until_us = 0;  ///< range that contains the periods before
  std::int64_t after_us = 0, to_us = 0;    ///< range that contains the periods after
};

/// Reads and compares summaries, kAtOnce buildings at a time, so that memory is bounded.
class PeriodReader {
 public:
  static constexpr std::size_t kAtOnce = 100;

  explicit PeriodReader(Database& database) : database_(database) {}

  /// Fills the buildings that have no period yet and have at least `least` periods before and
  /// after. buildings: by id in the database. Returns false if the database fails.
  [[nodiscard]] bool read(std::map<std::int64_t, ComparedBuilding>& buildings,
                          const ComparedTime& time, int least);

 private:
  struct Names {
    std::vector<std::string> name, unit;
    std::vector<std::int32_t> kind;
  };
  /// Reads the parameter names of the buildings into names_. Raises `stiffnesses` to the index
  /// after the last stiffness in the longest list.
  bool read_names(const std::string& ids, std::size_t& stiffnesses);
  bool read_some(const std::vector<std::int64_t>& ids,
                 std::map<std::int64_t, ComparedBuilding>& buildings, const ComparedTime& time,
                 int least);

  Database& database_;
  std::map<std::pair<std::int64_t, std::string>, Names> names_;
};

}  // namespace framewatch::fleet
