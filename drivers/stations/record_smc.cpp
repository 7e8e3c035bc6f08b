// SPDX-License-Identifier: MIT
// Accelerograms of the U.S. Geological Survey's SMC format: 11 lines of text, 48 integers, 50 real
// numbers, comments, values in cm/s2. Converse, Brady (1992), USGS Open-File Report 92-296A.
#include <cmath>

#include <fmt/core.h>

#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "drivers/records/record_builder.h"
#include "drivers/records/unit_text.h"
#include "drivers/stations/fortran_numbers.h"
#include "drivers/stations/station_channel.h"
#include "drivers/stations/station_formats.h"

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kSmcTextLines = 11;

/// Places in the headers of the values that are read, counted from 0.
enum class SmcInteger : std::size_t {
  undefined = 0,
  year = 1,
  day_of_year = 2,
  hour = 3,
  minute = 4,
  second = 5,
  millisecond = 6,
  channel = 8,
  from_up_deg = 12,
  azimuth_deg = 13,
  comments = 15,
  points = 16,
  problem = 17,
  floor = 24,
};
constexpr std::size_t kSmcIntegers = 48, kSmcReals = 50, kSmcUndefined = 0, kSmcRate_hz = 1;

struct SmcHeader {
  std::vector<std::string> text;
  std::vector<double> integers;
  double rate_hz = 0;

  std::optional<int> integer(SmcInteger field) const {
    const double value = integers[static_cast<std::size_t>(field)];
    if (value == integers[static_cast<std::size_t>(SmcInteger::undefined)] || std::abs(value) > 1e9)
      return std::nullopt;
    return static_cast<int>(value);
  }
};

/// Returns true for a corrected and false for an uncorrected accelerogram.
bool is_corrected(const SmcHeader& header) {
  return trimmed(header.text[0]).front() == '2';
}

std::string name_of(const SmcHeader& header) {
  const std::string_view line = trimmed(header.text[2]);
  std::string name(line.substr(0, line.find_first_of(" \t,\"")));
  if (name.empty()) name = "station";
  if (const auto channel = header.integer(SmcInteger::channel))
    name += fmt::format(".ch{:02}", *channel);
  return name;
}

AxisHeader axis_header(const SmcHeader& header) {
  AxisHeader out;
  const auto from_up = header.integer(SmcInteger::from_up_deg);
  const auto azimuth = header.integer(SmcInteger::azimuth_deg);
  if (from_up || azimuth) out.elevation_deg = 90 - from_up.value_or(90);
  if (azimuth && from_up.value_or(90) == 90) out.azimuth_deg = *azimuth;
  out.floor = header.integer(SmcInteger::floor);
  if (out.floor) out.place = fmt::format("floor {}", *out.floor);
  out.unit = "cm/s2";
  return out;
}

std::string treatment_text(const SmcHeader& header) {
  std::string text = is_corrected(header) ? "corrected" : "uncorrected";
  if (header.integer(SmcInteger::problem) == 1) text += "; the network reports a fault";
  return text + "; not used from the header: coordinates, event, the sensor's natural frequency";
}

std::optional<double> start_of(const SmcHeader& header, FileProblems& problems) {
  const auto year = header.integer(SmcInteger::year), day = header.integer(SmcInteger::day_of_year),
             hour = header.integer(SmcInteger::hour), minute = header.integer(SmcInteger::minute),
             second = header.integer(SmcInteger::second);
  if (!year || *year == 0 || !day || !hour || !minute || !second) return std::nullopt;
  const int millisecond = header.integer(SmcInteger::millisecond).value_or(0);
  const auto utc_s =
      utc_of(utc_of_day_of_year(*year, *day), *hour, *minute, *second + 1e-3 * millisecond);
  if (!utc_s) problems.add(kSmcTextLines + 1, "SMC: the header's start is not a valid time");
  return utc_s;
}

std::optional<SmcHeader> read_smc_header(LineReader& lines, FileProblems& problems) {
  SmcHeader header;
  std::string_view line;
  while (lines.number() < kSmcTextLines && lines.next(line)) header.text.emplace_back(line);
  if (lines.number() < kSmcTextLines) {
    if (!problems.any()) problems.add(0, "SMC: the file has fewer than 11 lines of text");
    return std::nullopt;
  }
  if (!is_smc_title(header.text[0]))
    return problems.add(1,
                        fmt::format("SMC: {} is neither 1 UNCORRECTED ACCELEROGRAM nor 2 CORRECTED "
                                    "ACCELEROGRAM",
                                    show_text(header.text[0])));
  auto integers =
      read_fortran_numbers(lines, {8, 10}, kSmcIntegers, "SMC: whole numbers", problems);
  if (!integers) return std::nullopt;
  header.integers = std::move(*integers);
  const auto reals = read_fortran_numbers(lines, {5, 15}, kSmcReals, "SMC: real numbers", problems);
  if (!reals) return std::nullopt;
  header.rate_hz = (*reals)[kSmcRate_hz];
  if (header.rate_hz == (*reals)[kSmcUndefined])
    return problems.add(kSmcTextLines + 7,
                        "SMC: the header has no sampling rate: the record was digitized at uneven "
                        "times, which is not supported; use the network's evenly sampled record");
  if (!(header.rate_hz > 0) || header.rate_hz > RecordBuilder::kMaxRateHz)
    problems.add(kSmcTextLines + 7,
                 fmt::format("SMC: {:g} samples per second is not a valid rate", header.rate_hz));
  const int comments = header.integer(SmcInteger::comments).value_or(0);
  for (int i = 0; i < comments && !problems.any(); ++i)
    if (!lines.next(line) || line.empty() || line.front() != '|')
      problems.add(lines.number(), fmt::format("SMC: only {} of {} comment lines", i, comments));
  return header;
}

}  // namespace

bool is_smc_title(std::string_view first_line) {
  const std::string_view title = trimmed(first_line);
  return title.starts_with("1 UNCORRECTED ACCEL") || title.starts_with("2 CORRECTED ACCEL");
}

std::optional<Record> read_smc(FileProblems& problems) {
  LineReader lines(problems);
  const auto header = read_smc_header(lines, problems);
  if (!header || problems.any()) return std::nullopt;
  const auto start_utc_s = start_of(*header, problems);
  const int points = header->integer(SmcInteger::points).value_or(0);
  if (points < 1) problems.add(kSmcTextLines + 3, "SMC: the header has no number of values");
  if (problems.any()) return std::nullopt;
  const std::int64_t line = lines.number() + 1;
  auto values = read_fortran_numbers(lines, {8, 10}, static_cast<std::size_t>(points),
                                     "SMC: values", problems);
  if (!values) return std::nullopt;
  for (double& value : *values) value *= kGal_mps2;
  return station_record({name_of(*header),
                         1 / header->rate_hz,
                         start_utc_s,
                         axis_header(*header),
                         {},
                         treatment_text(*header),
                         {}},
                        *values, line, 8, problems);
}

}  // namespace framewatch::drivers
