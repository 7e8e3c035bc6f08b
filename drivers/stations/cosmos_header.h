#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/base/file_problems.h"
#include "drivers/base/line_reader.h"

namespace framewatch::drivers {

/// Where the headers have what is read of them, from 0.
enum IntegerField {
  kStage = 0,
  kQuantity = 1,
  kUnit = 2,
  kReferenceAzimuth = 20,
  kYear = 39,
  kMonth = 41,
  kDay = 42,
  kHour = 43,
  kMinute = 44,
  kStationChannel = 49,
  kAzimuth = 53,
  kAzimuthToReference = 54,
  kProblemFlag = 75,
  kIntegers = 76,
};
enum RealField {
  kMicrovoltPerCount = 21,
  kSecond = 29,
  kStep_s = 33,
  kSensor_hz = 39,
  kSensorDamping = 40,
  kVoltPerG = 41,
  kGain = 46,
  kLowCorner_hz = 53,
  kHighCorner_hz = 56,
  kStep_ms = 61,
  kPeak = 63,
  kReals = 64,
};
/// The header of one channel: lines of text, whole numbers, real numbers, comments.
struct CosmosHeader {
  std::int64_t line = 0;
  std::vector<std::string> text;
  std::vector<double> integers, reals;
  double unknown_integer = -999, unknown_real = -999;
  std::string seed_name;  ///< from a comment; empty when there is none

  std::optional<double> integer(IntegerField field) const {
    const double value = integers[field];
    return value == unknown_integer || std::abs(value) > 1e9 ? std::nullopt : std::optional(value);
  }
  std::optional<double> real(RealField field) const {
    const double value = reals[field];
    return value == unknown_real ? std::nullopt : std::optional(value);
  }
};

/// The header whose first line, "... (Format v01.20 with 13 text lines)", has been read. Empty,
/// with a problem, when it is not whole.
std::optional<CosmosHeader> read_cosmos_header(LineReader& lines, std::string_view first_line,
                                               FileProblems& problems);

/// What follows `mark` in the header's text, to the end of its line; empty when it is not there.
std::string_view after(const CosmosHeader& header, std::string_view mark);

/// To the first blank.
std::string_view first_word(std::string_view text);

}  // namespace framewatch::drivers
