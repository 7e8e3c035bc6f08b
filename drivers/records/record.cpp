// SPDX-License-Identifier: MIT
#include "drivers/records/record.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/core.h>

namespace framewatch::drivers {
namespace {

constexpr double kMinRate_hz = 1, kMaxRate_hz = 1e4;

std::string place_in(const Record& record, const std::string& path, std::size_t row) {
  const bool known = row < record.lines.size() && record.lines[row] > 0;
  return known ? fmt::format("{}:{}", path, record.lines[row])
               : fmt::format("{}: at {:.6f} s", path, record.time_s[row]);
}

}  // namespace

std::string direction_text(const AxisHeader& header) {
  if (is_vertical(header)) return *header.elevation_deg > 0 ? "up" : "down";
  if (is_horizontal(header)) return fmt::format("azimuth {:g} deg", *header.azimuth_deg);
  if (header.azimuth_deg)
    return fmt::format("azimuth {:g} deg, {:g} deg above the horizontal", *header.azimuth_deg,
                       *header.elevation_deg);
  return "direction unknown";
}

std::vector<std::string> implausible(
    const Record& record, const std::string& path,
    const std::function<PlausibleRange(const std::string& name)>& range_of,
    std::vector<Problem>& problems) {
  std::vector<std::string> doubts;
  for (std::size_t c = 0; c < record.names.size(); ++c) {
    const PlausibleRange range = range_of(record.names[c]);
    const std::vector<double>& values = record.accel_mps2[c];
    std::size_t first = values.size(), worst = 0, count = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!(std::abs(range.scale * values[i]) > range.range_mps2)) continue;
      first = std::min(first, i);
      if (count == 0 || std::abs(values[i]) > std::abs(values[worst])) worst = i;
      ++count;
    }
    if (count == 0) continue;
    if (std::abs(values[worst]) > kMaxValue) {
      problems.push_back(
          {place_in(record, path, worst),
           fmt::format("{}: {:g} is not an acceleration", record.names[c], values[worst])});
      continue;
    }
    std::string doubt =
        fmt::format("{}: {}: {:g} m/s^2 is beyond {:g} m/s^2", place_in(record, path, first),
                    record.names[c], range.scale * values[first], range.range_mps2);
    if (count > 1)
      doubt += fmt::format("; {} of {} values are, the largest {:g} m/s^2", count, values.size(),
                           range.scale * values[worst]);
    doubts.push_back(doubt);
  }
  if (record.rate_hz < kMinRate_hz || record.rate_hz > kMaxRate_hz)
    doubts.push_back(
        fmt::format("{}: {:g} s from sample to sample, {:g} Hz: is the time in seconds?", path,
                    1 / record.rate_hz, record.rate_hz));
  return doubts;
}

}  // namespace framewatch::drivers
