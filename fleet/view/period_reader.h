#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fleet/store/database.h"
#include "fleet/view/comparison.h"

namespace framewatch::fleet {

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
