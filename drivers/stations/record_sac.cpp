// SPDX-License-Identifier: MIT
// Seismic Analysis Code, binary: one channel a file.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/core.h>

#include "drivers/files/number_text.h"
#include "drivers/files/packed_file.h"
#include "drivers/records/record_builder.h"
#include "drivers/stations/station_channel.h"
#include "drivers/stations/station_formats.h"
#include "drivers/stations/station_xml.h"

namespace framewatch::drivers {
namespace {

constexpr std::size_t kWordBytes = 4, kTextBegin = 440, kTextBytes = 8;
constexpr int kSacUndefined = -12345;

std::uint32_t word_at(const char* bytes, bool swapped) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes, sizeof word);
  return swapped ? __builtin_bswap32(word) : word;
}

/// Places in the header of the values that are read: words, and texts of eight characters, from 0.
enum class SacFloat : std::size_t { step_s = 0, begin_s = 5, azimuth_deg = 57, from_up_deg = 58 };
enum class SacInteger : std::size_t {
  year = 70,
  day_of_year = 71,
  hour = 72,
  minute = 73,
  second = 74,
  millisecond = 75,
  version = 76,
  points = 79,
  file_type = 85,
  quantity = 86,
  even = 105,
};
enum class SacText : std::size_t { station = 0, location = 3, channel = 20, network = 21 };

/// The header of a SAC file, version 6 or 7, in either byte order: 70 floats, 40 whole numbers, 192
/// characters. Undefined values are empty. SAC User Manual, "SAC data file format" (IRIS).
class SacHeader {
 public:
  /// Returns nullopt when the bytes are not such a header.
  static std::optional<SacHeader> read(std::string_view bytes) {
    if (bytes.size() < kSacHeaderBytes) return std::nullopt;
    SacHeader header;
    header.bytes_ = bytes.substr(0, kSacHeaderBytes);
    for (const bool swapped : {false, true}) {
      header.swapped_ = swapped;
      const auto version = header.integer(SacInteger::version),
                 points = header.integer(SacInteger::points);
      if ((version == 6 || version == 7) && points > 0 && header.number(SacFloat::step_s) > 0)
        return header;
    }
    return std::nullopt;
  }

  bool other_byte_order() const { return swapped_; }
  /// Returns the shortest decimal that rounds to the float: 0.005, not 0.004999999888.
  std::optional<double> number(SacFloat field) const {
    const auto value = std::bit_cast<float>(word(static_cast<std::size_t>(field)));
    if (!std::isfinite(value) || value == static_cast<float>(kSacUndefined)) return std::nullopt;
    return parse_number(fmt::format("{}", value));
  }

  std::optional<int> integer(SacInteger field) const {
    const auto value = std::bit_cast<std::int32_t>(word(static_cast<std::size_t>(field)));
    return value == kSacUndefined ? std::nullopt : std::optional<int>(value);
  }

  /// Returns a text without the blanks that pad it.
  std::string text(SacText field) const {
    std::string_view text(bytes_);
    text = text.substr(kTextBegin + static_cast<std::size_t>(field) * kTextBytes, kTextBytes);
    text = trimmed(text.substr(0, text.find('\0')));
    return std::string(text.starts_with("-12345") ? std::string_view() : text);
  }

 private:
  std::uint32_t word(std::size_t at) const {
    return word_at(bytes_.data() + at * kWordBytes, swapped_);
  }

  std::string bytes_;
  bool swapped_ = false;
};

/// Returns a value of four bytes in a file of that byte order.
float sac_value(const char* bytes, bool other_byte_order) {
  return std::bit_cast<float>(word_at(bytes, other_byte_order));
}

constexpr int kTimeSeries = 1, kDisplacement = 6, kVelocity = 7;

std::string name_of(const SacHeader& header) {
  std::string name;
  for (const SacText place :
       {SacText::network, SacText::station, SacText::location, SacText::channel}) {
    std::string part = header.text(place);
    for (char& c : part)
      if (c == ',' || c == '"' || c == '.') c = '_';
    name += (place == SacText::network ? "" : ".") + part;
  }
  return name == "..." ? "station" : name;
}

AxisHeader axis_header(const SacHeader& header) {
  AxisHeader out;
  const auto from_up = header.number(SacFloat::from_up_deg);
  if (from_up) out.elevation_deg = 90 - *from_up;
  if (from_up && *from_up != 0 && *from_up != 180)
    out.azimuth_deg = header.number(SacFloat::azimuth_deg);
  return out;
}

std::optional<double> start_of(const SacHeader& header, FileProblems& problems) {
  const auto year = header.integer(SacInteger::year), day = header.integer(SacInteger::day_of_year),
             hour = header.integer(SacInteger::hour), minute = header.integer(SacInteger::minute),
             second = header.integer(SacInteger::second);
  if (!year || !day || !hour || !minute || !second) return std::nullopt;
  const int millisecond = header.integer(SacInteger::millisecond).value_or(0);
  const auto utc_s = utc_of(utc_of_day_of_year(*year, *day), *hour, *minute, *second);
  if (!utc_s || std::abs(millisecond) > 999)
    return problems.add(0, "SAC: the header's start is not a valid time");
  return *utc_s + 1e-3 * millisecond + header.number(SacFloat::begin_s).value_or(0);
}

std::optional<std::vector<double>> read_values(GzipInput& file, const SacHeader& header,
                                               double unit_mps2, FileProblems& problems) {
  const auto points = static_cast<std::size_t>(header.integer(SacInteger::points).value_or(0));
  if (points > RecordBuilder::kMaxValues)
    return problems.add(0,
                        fmt::format("a record holds at most {} values", RecordBuilder::kMaxValues));
  std::vector<double> values;
  std::array<char, 4096> bytes{};
  while (values.size() < points) {
    const std::size_t wanted = std::min(bytes.size(), 4 * (points - values.size()));
    const std::int64_t got = file.read(bytes.data(), static_cast<std::int64_t>(wanted));
    if (got != static_cast<std::int64_t>(wanted))
      return problems.add(
          0, !file.error().empty()
                 ? file.error()
                 : fmt::format("SAC: the header announces {} values, but the file ends "
                               "early",
                               points));
    for (std::size_t at = 0; at < wanted; at += 4)
      values.push_back(
          unit_mps2 * static_cast<double>(sac_value(bytes.data() + at, header.other_byte_order())));
  }
  return values;
}

}  // namespace

bool is_sac_header(std::string_view bytes) {
  return SacHeader::read(bytes).has_value();
}

std::optional<Record> read_sac(const RecordOptions& options, FileProblems& problems) {
  GzipInput file(problems.path());
  std::string bytes(kSacHeaderBytes, '\0');
  const std::int64_t got = file.read(bytes.data(), std::ssize(bytes));
  const auto header = got == std::ssize(bytes) ? SacHeader::read(bytes) : std::nullopt;
  if (!header)
    return problems.add(
        0, file.error().empty() ? "is not a SAC file of version 6 or 7" : file.error());
  if (header->integer(SacInteger::file_type).value_or(kTimeSeries) != kTimeSeries ||
      header->integer(SacInteger::even).value_or(1) != 1)
    problems.add(0, "SAC: holds a spectrum or uneven steps, not an even time series");
  const int quantity = header->integer(SacInteger::quantity).value_or(0);
  if (quantity == kDisplacement || quantity == kVelocity)
    problems.add(0, "SAC: holds displacements or velocities, not accelerations");
  const double step_s = header->number(SacFloat::step_s).value_or(0);
  if (step_s * RecordBuilder::kMaxRateHz < 1)
    problems.add(0, fmt::format("SAC: the step of {:g} s is too short", step_s));
  StationChannel channel;
  channel.start_utc_s = start_of(*header, problems);
  if (problems.any()) return std::nullopt;
  channel.name = name_of(*header);
  const auto meanings = CountMeanings::read(options, problems);
  const auto meaning = meanings
                           ? meanings->of(channel.name, channel.start_utc_s, 1 / step_s, problems)
                           : std::nullopt;
  if (!meaning) return std::nullopt;
  const auto values = read_values(file, *header, meaning->unit_mps2, problems);
  if (!values) return std::nullopt;
  channel.step_s = step_s;
  channel.header = meaning->note.empty() ? axis_header(*header) : meaning->header;
  channel.treatment = (meaning->note.empty() ? "values times --unit" : meaning->note) +
                      "; not used from the header: coordinates, event, picks";
  return station_record(channel, *values, 0, values->size(), problems);
}

}  // namespace framewatch::drivers
