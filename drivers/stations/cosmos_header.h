#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/files/line_reader.h"

namespace framewatch::drivers {

/// Where the header has what is read of it, from 0.
enum class CosmosInteger : std::size_t {
  stage = 0,
  unit = 2,
  reference_azimuth = 20,
  year = 39,
  month = 41,
  day = 42,
  hour = 43,
  minute = 44,
  station_channel = 49,
  azimuth = 53,
  azimuth_to_reference = 54,
  problem_flag = 75,
};
enum class CosmosReal : std::size_t {
  microvolt_per_count = 21,
  second = 29,
  step_s = 33,
  sensor_hz = 39,
  sensor_damping = 40,
  volt_per_g = 41,
  gain = 46,
  north_m = 49,
  east_m = 50,
  up_m = 51,
  low_corner_hz = 53,
  high_corner_hz = 56,
  step_ms = 61,
  peak = 63,
};

/// The header of one channel: lines of text, whole numbers, real numbers, comments.
struct CosmosHeader {
  std::int64_t line = 0;
  std::vector<std::string> text;
  std::vector<double> integers, reals;
  double unknown_integer = -999, unknown_real = -999;
  std::string seed_name;  ///< from a comment; empty when there is none

  std::optional<double> integer(CosmosInteger field) const {
    const double value = integers[static_cast<std::size_t>(field)];
    return value == unknown_integer || std::abs(value) > 1e9 ? std::nullopt : std::optional(value);
  }
  std::optional<double> real(CosmosReal field) const {
    const double value = reals[static_cast<std::size_t>(field)];
    return value == unknown_real ? std::nullopt : std::optional(value);
  }
};

/// The header whose first line, "... (Format v01.20 with 13 text lines)", has been read. Empty,
/// with a problem, when it is not whole.
std::optional<CosmosHeader> read_cosmos_header(LineReader& lines, std::string_view first_line,
                                               FileProblems& problems);

/// What follows `mark` in the header's text, to the end of its line; empty when it is not there.
std::string_view after(const CosmosHeader& header, std::string_view mark);

bool holds(std::string_view text, std::string_view part);
/// To the first blank.
std::string_view first_word(std::string_view text);

}  // namespace framewatch::drivers
