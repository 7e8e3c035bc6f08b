#pragma once

#include <functional>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"

namespace framewatch::drivers {

/// How large a value of an axis may be before it is doubted.
struct PlausibleRange {
  double scale = 1;           ///< of the values, to m/s^2
  double range_mps2 = 200.0;  ///< no structure that is measured for its stiffness moves so
};

/// Values larger than this are refused: neither m/s^2 nor a converter's counts.
inline constexpr double kMaxValue = 1e12;

/// What a person should look at before the record is used, a line each: for each axis the first
/// value beyond its range at file:line, how many there are and the largest; a rate outside 1 Hz to
/// 10 kHz, which other times than seconds give. Values beyond kMaxValue are problems instead.
std::vector<std::string> implausible(
    const Record& record, const std::string& path,
    const std::function<PlausibleRange(const std::string& name)>& range_of,
    std::vector<Problem>& problems);

}  // namespace framewatch::drivers
