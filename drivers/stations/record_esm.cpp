// SPDX-License-Identifier: MIT
// Strong motion of the Engineering Strong-Motion database and of Italy's ITACA: lines of KEY: value
// (HEADER_FORMAT: DYNA 1.2), then one value a line. One channel a file.
// https://esm-db.eu (help: "DYNA 1.2 ASCII format"), https://itaca.mi.ingv.it
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "drivers/records/record_builder.h"
#include "drivers/records/unit_text.h"
#include "drivers/stations/station_channel.h"
#include "drivers/stations/station_formats.h"

namespace framewatch::drivers {
namespace {

constexpr std::size_t kMostHeaderLines = 200;
constexpr std::string_view kStartKey = "DATE_TIME_FIRST_SAMPLE_YYYYMMDD_HHMMSS";

struct EsmLine {
  std::int64_t line = 0;
  std::string text;
};

class EsmReader {
 public:
  explicit EsmReader(FileProblems& problems) : problems_(problems), lines_(problems) {}

  std::optional<Record> read() {
    std::string_view line;
    const bool any = read_header(line);
    const double step_s = number("SAMPLING_INTERVAL_S"), count = number("NDATA");
    const EsmLine unit = find("UNITS"), kind = find("DATA_TYPE");
    const auto unit_mps2 = mps2_per(unit.text);
    if (problems_.any()) return std::nullopt;
    if (kind.text.find("ACCELERATION") == std::string::npos ||
        kind.text.find("SPECTR") != std::string::npos)
      complain(kind, "DATA_TYPE", "must be an acceleration");
    if (!unit_mps2) complain(unit, "UNITS", "is not a known unit of acceleration");
    if (!(step_s * RecordBuilder::kMaxRateHz >= 1))
      complain(find("SAMPLING_INTERVAL_S"), "SAMPLING_INTERVAL_S", "must be a step in seconds");
    const auto start_utc_s = start();
    if (problems_.any()) return std::nullopt;
    StationChannel channel;
    channel.treatment = treatment();
    const std::int64_t first_line = lines_.number();
    const auto accel_mps2 =
        any ? read_values(line, *unit_mps2, channel.treatment) : std::vector<double>{};
    const std::size_t held = accel_mps2.size() + left_out_;
    if (static_cast<double>(held) != count && !problems_.any())
      complain(find("NDATA"), "NDATA", fmt::format("values, but the file has {}", held));
    if (problems_.any()) return std::nullopt;
    channel.step_s = step_s;
    channel.start_utc_s = start_utc_s;
    name_axis(channel);
    channel.header.unit = unit.text;
    if (const auto peak = parse_number(text("PGA_CM/S^2"))) channel.peak_mps2 = *peak * kGal_mps2;
    return station_record(channel, accel_mps2, first_line, 1, problems_);
  }

 private:
  /// Reads the lines of KEY: value and leaves `line` at the first value. Returns false if the
  /// file ends before a value.
  bool read_header(std::string_view& line) {
    while (lines_.next(line)) {
      if (parse_number(trimmed(line))) return true;
      const std::size_t colon = line.find(':');
      if (colon == std::string_view::npos || header_.size() >= kMostHeaderLines) {
        problems_.add(lines_.number(),
                      fmt::format("ESM: {} is neither KEY: value nor a number", show_text(line)));
        return false;
      }
      header_.insert({std::string(trimmed(line.substr(0, colon))),
                      {lines_.number(), std::string(trimmed(line.substr(colon + 1)))}});
    }
    return false;
  }

  /// Returns the value of a key; empty when the header does not have it.
  std::string text(std::string_view key) const {
    const auto at = header_.find(std::string(key));
    return at == header_.end() ? "" : at->second.text;
  }

  /// Returns the line of a key. Adds a problem when the header does not have it.
  EsmLine find(std::string_view key) {
    const auto at = header_.find(std::string(key));
    if (at != header_.end()) return at->second;
    if (!problems_.any()) problems_.add(0, fmt::format("ESM: the header has no {}", key));
    return {};
  }

  void complain(const EsmLine& at, std::string_view key, const std::string& rule) {
    problems_.add(at.line, fmt::format("ESM: {} {} {}", key, show_text(at.text), rule));
  }

  double number(std::string_view key) {
    const EsmLine at = find(key);
    const auto value = parse_number(at.text);
    if (!value && !problems_.any()) complain(at, key, "must be a number");
    return value.value_or(0);
  }

  /// Returns the values from `line` on, in m/s^2.
  std::vector<double> read_values(std::string_view line, double unit_mps2, std::string& treatment) {
    std::vector<double> values;
    for (bool more = true; more && !problems_.any(); more = lines_.next(line)) {
      const std::string_view field = trimmed(line);
      if (field.empty()) continue;
      if (!lines_.line_ended()) {
        treatment += "; " + lines_.left_out_note("number");
        left_out_ = 1;
        continue;
      }
      const auto value = parse_number(field);
      if (!value || !std::isfinite(*value))
        problems_.add(lines_.number(),
                      fmt::format("ESM: {} is not a finite number", show_text(field)));
      if (values.size() >= RecordBuilder::kMaxValues)
        problems_.add(lines_.number(), fmt::format("ESM: a record holds at most {} values",
                                                   RecordBuilder::kMaxValues));
      values.push_back(value.value_or(0) * unit_mps2);
    }
    return values;
  }

  /// Returns the time of the first sample since 1970, from "20190728_160919.870" in UTC. Returns
  /// nullopt when the header does not state it.
  std::optional<double> start() {
    const EsmLine at = find(kStartKey);
    if (at.text.empty()) return std::nullopt;
    const auto digits = [&](std::size_t from, std::size_t count) {
      return parse_integer(std::string_view(at.text).substr(from, count));
    };
    constexpr std::size_t kShortest = 15;
    const bool shaped = at.text.size() >= kShortest && at.text[8] == '_';
    if (shaped) {
      const auto year = digits(0, 4), month = digits(4, 2), day = digits(6, 2), hour = digits(9, 2),
                 minute = digits(11, 2);
      const auto second = parse_number(std::string_view(at.text).substr(13));
      if (year && month && day && hour && minute && second)
        if (const auto utc_s =
                utc_of(utc_of_date(static_cast<int>(*year), static_cast<int>(*month),
                                   static_cast<int>(*day)),
                       static_cast<double>(*hour), static_cast<double>(*minute), *second))
          return utc_s;
    }
    complain(at, kStartKey, "is not a time such as 20190728_160919.870");
    return std::nullopt;
  }

  /// Sets name, direction and place. The last letter of the stream says the direction.
  void name_axis(StationChannel& channel) {
    const std::string stream = find("STREAM").text;
    channel.name =
        fmt::format("{}.{}.{}.{}", text("NETWORK"), text("STATION_CODE"), text("LOCATION"), stream);
    const char axis = stream.empty() ? ' ' : stream.back();
    AxisHeader& header = channel.header;
    if (axis == 'Z') header.elevation_deg = 90;
    if (axis == 'N' || axis == 'E')
      header.elevation_deg = 0, header.azimuth_deg = axis == 'E' ? 90 : 0;
    if (axis != 'Z' && axis != 'N' && axis != 'E')
      channel.direction = fmt::format("stream {}, azimuth unknown", show_text(stream));
    const auto depth_m = parse_number(text("SENSOR_DEPTH_M"));
    if (depth_m && *depth_m > 0) header.place = fmt::format("in a borehole, {:g} m deep", *depth_m);
  }

  std::string treatment() const {
    const auto low_hz = parse_number(text("LOW_CUT_FREQUENCY_HZ")),
               high_hz = parse_number(text("HIGH_CUT_FREQUENCY_HZ"));
    std::string out = "uncorrected";
    if (low_hz && high_hz) out = fmt::format("corrected, {:g} to {:g} Hz kept", *low_hz, *high_hz);
    return out + "; not used from the header: coordinates, event, site";
  }

  FileProblems& problems_;
  LineReader lines_;
  std::map<std::string, EsmLine> header_;
  std::size_t left_out_ = 0;  ///< values at the end that may be cut off
};

}  // namespace

bool is_esm_title(std::string_view first_line) {
  return first_line.starts_with("EVENT_NAME:");
}

std::optional<Record> read_esm(FileProblems& problems) {
  return EsmReader(problems).read();
}

}  // namespace framewatch::drivers
