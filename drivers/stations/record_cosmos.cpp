// SPDX-License-Identifier: MIT
// Strong motion as COSMOS networks publish it (CESMD, USGS, CGS), format v1.20: raw counts (V0),
// uncorrected (V1) and corrected (V2) acceleration, one channel a file (V1c) or several.
// COSMOS Strong-Motion Programs Board (2001), "COSMOS strong motion data format", tables of 2015.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "drivers/files/file_problems.h"
#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "drivers/records/record_builder.h"
#include "drivers/records/unit_text.h"
#include "drivers/stations/fortran_numbers.h"
#include "drivers/stations/station_channel.h"
#include "drivers/stations/station_formats.h"

namespace framewatch::drivers {
namespace {

/// Places in the header of the values that are read, counted from 0.
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

/// The header of one channel: lines of text, whole numbers, real numbers and comments.
struct CosmosHeader {
  std::int64_t line = 0;
  std::vector<std::string> text;
  std::vector<double> integers, reals;
  double unknown_integer = -999, unknown_real = -999;
  std::string seed_name;  ///< from a comment, or empty

  std::optional<double> integer(CosmosInteger field) const {
    const double value = integers[static_cast<std::size_t>(field)];
    return value == unknown_integer || std::abs(value) > 1e9 ? std::nullopt : std::optional(value);
  }
  std::optional<double> real(CosmosReal field) const {
    const double value = reals[static_cast<std::size_t>(field)];
    return value == unknown_real ? std::nullopt : std::optional(value);
  }
};

bool holds(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// Returns `text` up to its first blank.
std::string_view first_word(std::string_view text) {
  return text.substr(0, text.find_first_of(" \t"));
}

/// Returns what follows `mark` in the header's text, to the end of its line; empty without `mark`.
std::string_view after(const CosmosHeader& header, std::string_view mark) {
  for (const std::string& line : header.text)
    if (const auto at = line.find(mark); at != std::string::npos)
      return trimmed(std::string_view(line).substr(at + mark.size()));
  return {};
}

constexpr std::size_t kIntegersRead = 76, kRealsRead = 64;

/// Reads a line such as "100 Real-header values follow on 20 lines, Format= (5F15.6)" and the
/// values. `mark` is a part of that line; `what` names the values in messages.
std::vector<double> read_list(LineReader& lines, std::string_view mark, std::string_view what,
                              std::size_t least, FileProblems& problems) {
  std::string_view line;
  if (!lines.next(line) || !holds(line, mark)) {
    if (!problems.any())
      problems.add(lines.number(), fmt::format("COSMOS: expected the line of the {}", what));
    return {};
  }
  const auto count = parse_integer(first_word(trimmed(line)));
  const auto format = find_fortran_format(line);
  if (!count || !format || *count < static_cast<std::int64_t>(least)) {
    problems.add(lines.number(),
                 fmt::format("COSMOS: the line of the {} must give their number, at least "
                             "{}, and a format such as (10I8)",
                             what, least));
    return {};
  }
  return read_fortran_numbers(lines, *format, static_cast<std::size_t>(*count), what, problems)
      .value_or(std::vector<double>{});
}

/// Reads "Values used when parameter or data value is unknown/unspecified:   -999, -999.00".
void read_unknown(CosmosHeader& header) {
  std::vector<std::string_view> fields;
  split_commas(after(header, "unspecified:"), fields);
  if (const auto value = parse_number(fields.front())) header.unknown_integer = *value;
  if (const auto value = parse_number(fields.back())) header.unknown_real = *value;
}

/// Reads the comments, of which "|<SCNL>8040.HNE.NP.01" names station, channel, network and
/// location.
void read_comments(LineReader& lines, CosmosHeader& header, FileProblems& problems) {
  std::string_view line;
  if (!lines.next(line)) return;
  const auto count = parse_integer(first_word(trimmed(line)));
  if (!count || *count < 0 || !holds(line, "omment")) {
    problems.add(lines.number(), "COSMOS: expected the number of comment lines");
    return;
  }
  for (std::int64_t i = 0; i < *count && lines.next(line); ++i) {
    const auto at = line.find("<SCNL>");
    if (at == std::string_view::npos) continue;
    std::string dotted(first_word(line.substr(at + 6)));
    std::vector<std::string> parts(1);
    for (const char c : dotted) {
      if (c == '.')
        parts.emplace_back();
      else
        parts.back() += c;
    }
    if (parts.size() == 4)
      header.seed_name = fmt::format("{}.{}.{}.{}", parts[2], parts[0], parts[3], parts[1]);
  }
}

/// Reads the header whose first line, "... (Format v01.20 with 13 text lines)", has been read.
/// Returns nullopt with a problem when it is incomplete.
std::optional<CosmosHeader> read_cosmos_header(LineReader& lines, std::string_view first,
                                               FileProblems& problems) {
  CosmosHeader header;
  header.line = lines.number();
  header.text.emplace_back(first);
  const auto with = first.find("with");
  const auto count = parse_integer(
      with == std::string_view::npos ? "" : first_word(trimmed(first.substr(with + 4))));
  if (!count || *count < 2 || *count > 100)
    return problems.add(header.line, "COSMOS: the first line must give the number of text lines");
  std::string_view line;
  while (header.text.size() < static_cast<std::size_t>(*count) && lines.next(line))
    header.text.emplace_back(line);
  read_unknown(header);
  header.integers =
      read_list(lines, "nteger-header values", "integer-header values", kIntegersRead, problems);
  if (problems.any()) return std::nullopt;
  header.reals = read_list(lines, "eal-header values", "real-header values", kRealsRead, problems);
  if (problems.any()) return std::nullopt;
  read_comments(lines, header, problems);
  return header;
}

constexpr double kMicro = 1e-6;

constexpr int kCounts = 50;

/// Returns the m/s^2 in a unit code of the format (table 2). Returns nullopt when the code is not a
/// unit of acceleration.
std::optional<double> mps2_of(int unit, const CosmosHeader& header) {
  switch (unit) {
    case 2:
      return kStandardGravity_mps2;
    case 4:
    case 10:
      return 0.01;
    case 7:
      return 0.0254;
    case 11:
      return 1e-3 * kStandardGravity_mps2;
    case 12:
      return kMicro * kStandardGravity_mps2;
    case kCounts: {
      const auto step = header.real(CosmosReal::microvolt_per_count),
                 sensitivity = header.real(CosmosReal::volt_per_g);
      const double gain = header.real(CosmosReal::gain).value_or(1);
      if (!step || !sensitivity || !(*step > 0) || !(*sensitivity > 0) || !(gain > 0))
        return std::nullopt;
      return *step * kMicro / *sensitivity / gain * kStandardGravity_mps2;
    }
    default:
      return std::nullopt;
  }
}

/// Returns the words for direction codes other than azimuths (table 6 of the format).
std::string direction_words(int code) {
  constexpr std::array<std::pair<int, const char*>, 7> kWords = {{
      {402, "vertical, up or down unknown"},
      {500, "radial"},
      {501, "transverse"},
      {600, "along the structure"},
      {601, "across the structure"},
      {700, "horizontal, azimuth unknown"},
      {701, "horizontal, azimuth unknown"},
  }};
  for (const auto& [known, word] : kWords)
    if (code == known) return word;
  return {};
}

const char* unit_text(int unit) {
  switch (unit) {
    case 2:
      return "g";
    case 7:
      return "in/s2";
    case 11:
      return "mg";
    case 12:
      return "ug";
    case kCounts:
      return "count";
    default:
      return "cm/s2";
  }
}

/// Returns direction, place and unit. Sets `direction` when only words can say it.
AxisHeader axis_header(const CosmosHeader& header, int unit, std::string& direction) {
  constexpr int kUp = 400, kDown = 401;
  AxisHeader out;
  out.place = after(header, "Location:");
  out.unit = unit_text(unit);
  out.north_m = header.real(CosmosReal::north_m);
  out.east_m = header.real(CosmosReal::east_m);
  out.up_m = header.real(CosmosReal::up_m);
  const auto absolute = header.integer(CosmosInteger::azimuth);
  const auto value = absolute ? absolute : header.integer(CosmosInteger::azimuth_to_reference);
  if (!value) return out;
  if (*value == kUp || *value == kDown) out.elevation_deg = *value == kUp ? 90 : -90;
  direction = direction_words(static_cast<int>(*value));
  if (*value < 0 || *value > 360) return out;
  const auto reference = header.integer(CosmosInteger::reference_azimuth);
  if (absolute)
    out.azimuth_deg = *value;
  else if (reference)
    out.azimuth_deg = std::fmod(*value + *reference, 360);
  else
    direction = fmt::format("{:g} deg from an axis of unknown azimuth", *value);
  if (out.azimuth_deg) out.elevation_deg = 0;
  return out;
}

std::string stage_text(const CosmosHeader& header, double unit_mps2) {
  const int stage = static_cast<int>(header.integer(CosmosInteger::stage).value_or(-1));
  if (stage == 0) return fmt::format("raw, {:.6g} m/s2 per count", unit_mps2);
  if (stage == 1) return "uncorrected";
  const auto low_hz = header.real(CosmosReal::low_corner_hz),
             high_hz = header.real(CosmosReal::high_corner_hz);
  if (stage != 2) return "processing stage unknown";
  if (!low_hz || !high_hz) return "corrected";
  return fmt::format("corrected, {:g} to {:g} Hz kept", *low_hz, *high_hz);
}

std::string treatment_text(const CosmosHeader& header, double unit_mps2) {
  std::string text = stage_text(header, unit_mps2);
  const auto flag = header.integer(CosmosInteger::problem_flag);
  if (flag == 1) text += "; the network corrected a fault";
  if (flag == 2) text += "; the network reports a fault";
  text += "; not used from the header: coordinates, event";
  if (const auto sensor_hz = header.real(CosmosReal::sensor_hz); sensor_hz && *sensor_hz > 0)
    text += fmt::format(", the sensor's natural frequency {:.3g} Hz (damping {:.2g})", *sensor_hz,
                        header.real(CosmosReal::sensor_damping).value_or(0));
  return text;
}

std::string name_of(const CosmosHeader& header) {
  if (!header.seed_name.empty()) return header.seed_name;
  std::string name(first_word(after(header, "Code:")));
  if (name.empty()) name = "station";
  for (char& c : name)
    if (c == '-') c = '.';
  return fmt::format("{}.ch{:02}", name,
                     header.integer(CosmosInteger::station_channel).value_or(0));
}

class CosmosReader {
 public:
  CosmosReader(const RecordOptions& options, FileProblems& problems)
      : options_(options), problems_(problems), lines_(problems) {}

  /// Returns one record for each channel of the file.
  std::vector<Record> read() {
    std::vector<Record> records;
    for (std::string_view line; !problems_.any() && lines_.next(line);) {
      const std::string_view words = trimmed(line);
      if (words.empty() || words.starts_with(kEndOfChannel) || holds(line, "End-of-data")) continue;
      if (holds(line, "(Format v")) {
        header_ = read_cosmos_header(lines_, line, problems_);
        continue;
      }
      if (auto record = read_values(line)) records.push_back(std::move(*record));
    }
    if (!problems_.any() && records.empty())
      problems_.add(0, "COSMOS: no acceleration in the file");
    if (left_out_ > 0 && !records.empty())
      records.front().notes.push_back("velocity and displacement in the file were left out");
    return records;
  }

 private:
  /// Reads the values below "42000 acceleration pts, approx 210 secs,
  /// units=cm/sec2(04),Format=(1E15.6)".
  std::optional<Record> read_values(std::string_view line) {
    const std::int64_t at = lines_.number();
    const auto count = parse_integer(first_word(trimmed(line)));
    const auto format = find_fortran_format(line);
    if (!header_ || !count || *count < 1 || !format || !holds(line, "pts"))
      return problems_.add(
          at, fmt::format("COSMOS: {} is neither a header nor a line with the number and "
                          "format of values",
                          show_text(line)));
    const bool is_accel = holds(line, "accel") || holds(line, "Accel") || holds(line, "ACCEL");
    auto values = read_fortran_numbers(lines_, *format, static_cast<std::size_t>(*count),
                                       "COSMOS values", problems_);
    if (!values) return std::nullopt;
    if (!is_accel) {
      ++left_out_;
      return std::nullopt;
    }
    return accel_record(std::move(*values), at + 1, format->per_line);
  }

  std::optional<Record> accel_record(std::vector<double> values, std::int64_t line,
                                     std::size_t per_line) {
    const int unit = static_cast<int>(header_->integer(CosmosInteger::unit).value_or(0));
    const auto unit_mps2 = mps2_of(unit, *header_);
    const auto step_ms = header_->real(CosmosReal::step_ms);
    const double step_s =
        step_ms && *step_ms > 0 ? *step_ms / 1000 : header_->real(CosmosReal::step_s).value_or(0);
    if (!unit_mps2)
      problems_.add(
          header_->line,
          unit == kCounts
              ? std::string("COSMOS: the values are counts, but the header lacks microvolts "
                            "per count or volts per g")
              : fmt::format("COSMOS: the header's unit {} is not a known unit of acceleration",
                            unit));
    if (!(step_s > 0)) problems_.add(header_->line, "COSMOS: the header has no time step");
    const auto start_utc_s = start();
    if (problems_.any()) return std::nullopt;
    for (double& value : values) value *= *unit_mps2;
    StationChannel channel;
    channel.name = name_of(*header_);
    channel.step_s = step_s;
    channel.start_utc_s = start_utc_s;
    channel.header = axis_header(*header_, unit, channel.direction);
    channel.treatment = treatment_text(*header_, *unit_mps2);
    if (const auto peak = header_->real(CosmosReal::peak); peak && unit != kCounts)
      channel.peak_mps2 = *peak * *unit_mps2;
    return station_record(channel, values, line, per_line, problems_);
  }

  std::optional<double> start() {
    const auto year = header_->integer(CosmosInteger::year),
               month = header_->integer(CosmosInteger::month),
               day = header_->integer(CosmosInteger::day),
               hour = header_->integer(CosmosInteger::hour),
               minute = header_->integer(CosmosInteger::minute);
    const auto second = header_->real(CosmosReal::second);
    if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
    const auto utc_s = utc_of(
        utc_of_date(static_cast<int>(*year), static_cast<int>(*month), static_cast<int>(*day)),
        *hour, *minute, *second);
    if (!utc_s)
      return problems_.add(header_->line, "COSMOS: the header's start is not a valid time");
    const std::string_view said = after(*header_, "start time:");
    const bool utc = holds(said, "UTC") || holds(said, "GMT");
    if (utc && options_.zone_min)
      problems_.add(header_->line, "COSMOS: the header states its zone: --zone does not apply");
    if (!utc && !options_.zone_min)
      return problems_.add(header_->line,
                           "COSMOS: the header does not say the zone of its start: declare "
                           "it with --zone Z or, for example, --zone +09:00");
    return *utc_s - 60.0 * options_.zone_min.value_or(0);
  }

  const RecordOptions& options_;
  FileProblems& problems_;
  LineReader lines_;
  std::optional<CosmosHeader> header_;
  int left_out_ = 0;
};

}  // namespace

std::optional<Record> read_cosmos(const RecordOptions& options, FileProblems& problems) {
  return merge_channels(CosmosReader(options, problems).read(), problems);
}

}  // namespace framewatch::drivers
