// SPDX-License-Identifier: MIT
// Strong motion of California's CSMIP (CGS, formerly CDMG) and of networks that use its format:
// uncorrected (volume 1) and corrected (volume 2) acceleration, one channel a file or several.
// Shakal, Huang (1985), "Standard tape format for CSMIP strong-motion data tapes", OSMS 85-03.
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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

constexpr std::string_view kVolume1 = "uncorrected accelerogram data",
                           kVolume2 = "corrected accelerogram",
                           kVolume3 = "response and fourier amplitude spectra";

/// Lines of text in the headers. A header of volume 2 has a first line more than one of volume 1,
/// and more lines at the end.
constexpr std::size_t kTextLines1 = 13, kTextLines2 = 25;
enum class CsmipLine : std::size_t { start = 3, station = 4, channel = 6, points = 10, unit = 11 };
constexpr std::size_t kStationColumn = 11, kStationWidth = 6;

constexpr FortranFormat kIntegers{16, 5}, kReals{8, 10}, kPairs{10, 7};
constexpr std::size_t kIntegerCount = 100, kRealCount1 = 50, kRealCount2 = 100;
constexpr std::size_t kRecordPoints = 27;  ///< in volume 1; places are counted from 0
enum class CsmipReal : std::size_t { step_s = 60, low_hz = 61, peak = 65, high_hz = 72 };

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// Returns what follows `mark`; empty without it.
std::string_view after(std::string_view text, std::string_view mark) {
  const std::size_t at = text.find(mark);
  return at == std::string_view::npos ? "" : trimmed(text.substr(at + mark.size()));
}

/// Returns `text` up to the first of `ends`.
std::string_view up_to(std::string_view text, std::string_view ends) {
  return trimmed(text.substr(0, text.find_first_of(ends)));
}

/// The header of one channel. Texts are in lower case, but for the place.
struct CsmipHeader {
  std::int64_t line = 0;
  bool corrected = false;
  std::vector<std::string> text;
  std::string place;  ///< "Roof - South Wall", from "Location: ..."
  std::vector<double> integers, reals;

  const std::string& at(CsmipLine field) const {
    return text[static_cast<std::size_t>(field) + (corrected ? 1 : 0)];
  }
  /// Returns a positive number of volume 2; nullopt when it is unknown.
  std::optional<double> real(CsmipReal field) const {
    const auto i = static_cast<std::size_t>(field);
    return i < reals.size() && reals[i] > 0 ? std::optional(reals[i]) : std::nullopt;
  }
};

/// Returns the number of a channel, its direction and how the line shows it, from "Chan  5: 90 Deg
/// (Sta Chn:  7)  Location: Roof".
struct CsmipChannel {
  std::string number;
  AxisHeader axis;
  std::string direction;
};

CsmipChannel channel_of(const CsmipHeader& header) {
  const std::string& line = header.at(CsmipLine::channel);
  CsmipChannel out;
  const std::string_view of_station = up_to(after(line, "sta chn:"), ") ");
  out.number = of_station.empty() ? up_to(after(line, "chan"), ":") : of_station;
  if (out.number.size() == 1) out.number = "0" + out.number;
  out.axis.place = header.place;
  const std::string_view colon = after(line, ":");
  const std::string_view words = up_to(colon.substr(0, colon.find("location:")), "(");
  const std::string_view degrees = up_to(words.substr(0, words.find("deg")), "");
  const auto azimuth_deg = parse_number(degrees);
  if (words == "up" || words == "down" || words == "dn")
    out.axis.elevation_deg = words == "up" ? 90 : -90;
  else if (azimuth_deg && degrees.size() < words.size() && *azimuth_deg >= 0 && *azimuth_deg <= 360)
    out.axis.azimuth_deg = std::fmod(*azimuth_deg, 360), out.axis.elevation_deg = 0;
  else
    out.direction = fmt::format("{}, azimuth unknown", show_text(words));
  return out;
}

/// Returns the unit that a line names: "in cm/sec2.", "in units of g .", "(units: g/10)", "sec and
/// g/10.".
std::string_view unit_named_in(std::string_view line) {
  for (const std::string_view mark : {"units of ", "units:", " in ", " and "}) {
    const std::size_t at = line.rfind(mark);
    if (at == std::string_view::npos) continue;
    std::string_view unit = up_to(trimmed(line.substr(at + mark.size())), " .),");
    if (mps2_per(unit) || unit == "g/10") return unit;
  }
  return {};
}

std::optional<double> mps2_of(std::string_view unit) {
  return unit == "g/10" ? kStandardGravity_mps2 / 10 : mps2_per(unit);
}

/// Returns the step that a line names: "at .005 sec", "at 200 pts/sec", "at 200 samples/sec".
/// Returns nullopt when it names none.
std::optional<double> step_named_in(std::string_view line) {
  const std::string_view words = after(line, " at ");
  const auto number = parse_number(up_to(words, " "));
  if (!number || !(*number > 0)) return std::nullopt;
  const std::string_view unit = up_to(after(words, " "), " .,");
  if (unit == "pts/sec" || unit == "samples/sec") return 1 / *number;
  return unit == "sec" ? number : std::nullopt;
}

/// Returns the format of the values that a line names, "(8f9.6)", or the volume's usual one.
FortranFormat format_named_in(std::string_view line, bool corrected) {
  const std::size_t open = line.rfind('(');
  const auto named = open == std::string_view::npos
                         ? std::nullopt
                         : find_fortran_format("format" + std::string(line.substr(open)));
  return named.value_or(corrected ? FortranFormat{8, 10} : FortranFormat{8, 9});
}

/// Values of one quantity below the header.
struct CsmipValues {
  std::string line;  ///< in lower case: "7500 points of accel data equally spaced at .010 sec, ..."
  std::int64_t first_line = 0;
  std::size_t per_line = 1;
  std::vector<double> values;
};

class CsmipReader {
 public:
  CsmipReader(const RecordOptions& options, FileProblems& problems)
      : options_(options), problems_(problems), lines_(problems) {}

  /// Returns one record for each channel of the file.
  std::vector<Record> read() {
    std::vector<Record> records;
    for (std::string_view line; !problems_.any() && lines_.next(line);) {
      if (trimmed(line).empty() || trimmed(line).starts_with(kEndOfChannel)) continue;
      const std::string first = lower(line);
      if (first.starts_with(kVolume3)) {
        problems_.add(lines_.number(),
                      "CSMIP: volume 3 holds spectra, no accelerations: use volume 1 or 2 of the "
                      "record (.V1, .V2)");
      } else if (first.starts_with(kVolume1) || first.starts_with(kVolume2)) {
        if (!read_header(line)) break;
        if (!header_->corrected) add(read_volume_1(), records);
      } else if (header_ && header_->corrected) {
        add(read_quantity(first), records);
      } else {
        problems_.add(
            lines_.number(),
            fmt::format("CSMIP: {} is neither a header nor the number of points", show_text(line)));
      }
    }
    if (!problems_.any() && records.empty()) problems_.add(0, "CSMIP: no acceleration in the file");
    if (left_out_ > 0 && !records.empty())
      records.front().notes.push_back("velocity and displacement in the file were left out");
    return records;
  }

 private:
  void add(const std::optional<CsmipValues>& found, std::vector<Record>& records) {
    if (!found) return;
    auto record = accel_record(*found);
    if (record) records.push_back(std::move(*record));
  }

  bool read_header(std::string_view line) {
    CsmipHeader header;
    step_s_ = 0;
    header.line = lines_.number();
    header.corrected = lower(line).starts_with(kVolume2);
    const std::size_t count = header.corrected ? kTextLines2 : kTextLines1;
    const std::size_t channel =
        static_cast<std::size_t>(CsmipLine::channel) + (header.corrected ? 1 : 0);
    header.text.push_back(lower(line));
    while (header.text.size() < count && lines_.next(line)) {
      const std::string text = lower(line);
      const std::size_t at = text.find("location:");
      if (header.text.size() == channel && at != std::string::npos)
        header.place = trimmed(line.substr(at + 9));
      header.text.push_back(text);
    }
    if (header.text.size() < count && !problems_.any())
      problems_.add(lines_.number(),
                    fmt::format("CSMIP: only {} of {} lines of text", header.text.size(), count));
    if (!problems_.any() && !header.at(CsmipLine::station).starts_with("station"))
      problems_.add(
          header.line + static_cast<std::int64_t>(CsmipLine::station) + (header.corrected ? 1 : 0),
          "CSMIP: this line of the header must begin with Station No.");
    if (!problems_.any() && !header.at(CsmipLine::channel).starts_with("chan"))
      problems_.add(header.line + static_cast<std::int64_t>(channel),
                    "CSMIP: this line of the header must begin with Chan");
    if (problems_.any()) return false;
    auto integers =
        read_fortran_numbers(lines_, kIntegers, kIntegerCount, "CSMIP: whole numbers", problems_);
    if (!integers) return false;
    auto reals = read_fortran_numbers(lines_, kReals, header.corrected ? kRealCount2 : kRealCount1,
                                      "CSMIP: real numbers", problems_);
    if (!reals) return false;
    header.integers = std::move(*integers);
    header.reals = std::move(*reals);
    header_ = std::move(header);
    return true;
  }

  /// Reads what follows a header of volume 1: a line with the number of points and the values, or
  /// at once pairs of time and value.
  std::optional<CsmipValues> read_volume_1() {
    std::string_view line;
    if (!lines_.next(line)) {
      if (!problems_.any()) problems_.add(lines_.number(), "CSMIP: the file ends after a header");
      return std::nullopt;
    }
    const std::string first = lower(line);
    if (first.find("points") != std::string::npos) return read_quantity(first);
    return read_pairs(line);
  }

  /// Reads the values below `line`. Returns nullopt, without a problem, when they are velocities or
  /// displacements.
  std::optional<CsmipValues> read_quantity(const std::string& line) {
    CsmipValues out{line, lines_.number() + 1, 0, {}};
    const auto count = parse_integer(up_to(trimmed(line), " "));
    if (!count || *count < 1 || line.find("points") == std::string::npos)
      return problems_.add(lines_.number(), fmt::format("CSMIP: {} is neither a header nor the "
                                                        "number of points",
                                                        show_text(line)));
    const FortranFormat format = format_named_in(line, header_->corrected);
    auto values = read_fortran_numbers(lines_, format, static_cast<std::size_t>(*count),
                                       "CSMIP: values", problems_);
    if (!values) return std::nullopt;
    if (line.find("accel") == std::string::npos) {
      ++left_out_;
      return std::nullopt;
    }
    out.per_line = format.per_line;
    out.values = std::move(*values);
    return out;
  }

  /// Reads times and values, five pairs a line, of which `line` is the first.
  std::optional<CsmipValues> read_pairs(std::string_view line) {
    const double points = header_->integers[kRecordPoints];
    CsmipValues out{header_->at(CsmipLine::unit), lines_.number(), kPairs.per_line / 2, {}};
    if (!(points >= 2 && points <= static_cast<double>(RecordBuilder::kMaxValues) / 2))
      return problems_.add(header_->line, "CSMIP: the header has no number of points");
    const auto count = static_cast<std::size_t>(points);
    std::vector<double> numbers;
    const std::string first(line);
    const bool ended = lines_.line_ended();
    for (std::size_t at = 0; at < first.size() && numbers.size() < 2 * count; at += kPairs.width) {
      const std::string_view field = trimmed(std::string_view(first).substr(at, kPairs.width));
      if (field.empty()) break;
      const auto number = parse_number(field);
      if (!number || !std::isfinite(*number))
        return problems_.add(out.first_line,
                             fmt::format("CSMIP: {} is not a finite number", show_text(field)));
      numbers.push_back(*number);
    }
    if (numbers.size() < 2 * count && ended) {
      const auto more = read_fortran_numbers(lines_, kPairs, 2 * count - numbers.size(),
                                             "CSMIP: times and values", problems_);
      if (!more) return std::nullopt;
      numbers.insert(numbers.end(), more->begin(), more->end());
    }
    if (numbers.size() < 2 * count)
      return problems_.add(lines_.number(), "CSMIP: the file ends within the first line of values");
    if (!check_even(numbers)) return std::nullopt;
    for (std::size_t i = 1; i < numbers.size(); i += 2) out.values.push_back(numbers[i]);
    return out;
  }

  /// Reports times, every other one of `numbers`, that lie off an even step by more than a tenth of
  /// it and the rounding to 0.001 s. Sets step_s_.
  bool check_even(const std::vector<double>& numbers) {
    constexpr double kRounding_s = 0.0005;
    const double first_s = numbers.front(), last_s = numbers[numbers.size() - 2];
    step_s_ = (last_s - first_s) / (static_cast<double>(numbers.size()) / 2 - 1);
    double worst_s = 0;
    for (std::size_t i = 0; i < numbers.size(); i += 2)
      worst_s =
          std::max(worst_s, std::abs(numbers[i] - first_s - static_cast<double>(i) / 2 * step_s_));
    if (step_s_ > 0 && worst_s <= RecordBuilder::kStepTolerance * step_s_ + kRounding_s)
      return true;
    problems_.add(header_->line,
                  fmt::format("CSMIP: the record was digitized at uneven times, up to {:.4g} s off "
                              "an even step, which is not supported: use its volume 2 (.V2)",
                              worst_s));
    return false;
  }

  std::optional<Record> accel_record(const CsmipValues& found) {
    const std::string_view unit = unit_named_in(found.line);
    const auto unit_mps2 = mps2_of(unit);
    if (!unit_mps2)
      return problems_.add(found.first_line - 1,
                           fmt::format("CSMIP: {} names no unit of acceleration (g, g/10, cm/sec2)",
                                       show_text(found.line)));
    const CsmipChannel axis = channel_of(*header_);
    StationChannel channel;
    channel.name = fmt::format("{}.ch{}", station(), axis.number);
    channel.step_s = step(found.line);
    channel.start_utc_s = start();
    if (!(channel.step_s > 0)) problems_.add(found.first_line - 1, "CSMIP: no time step is stated");
    if (channel.step_s * RecordBuilder::kMaxRateHz < 1 && channel.step_s > 0)
      problems_.add(found.first_line - 1, "CSMIP: the time step is too short");
    if (problems_.any()) return std::nullopt;
    channel.header = axis.axis;
    channel.header.unit = unit;
    channel.direction = axis.direction;
    channel.treatment = treatment();
    if (header_->corrected) {
      const double peak = header_->reals[static_cast<std::size_t>(CsmipReal::peak)];
      if (peak != 0 && peak != kUnknown) channel.peak_mps2 = peak * kGal_mps2;
    }
    std::vector<double> accel_mps2 = found.values;
    for (double& value : accel_mps2) value *= *unit_mps2;
    return station_record(channel, accel_mps2, found.first_line, found.per_line, problems_);
  }

  /// Returns the station's number in "Station No. 58667   37.973N, 122.038W", or the file's name.
  std::string station() const {
    const std::string& line = header_->at(CsmipLine::station);
    std::string name(
        line.size() > kStationColumn
            ? up_to(std::string_view(line).substr(kStationColumn, kStationWidth), ",\"")
            : "");
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return name.empty() ? name_of_file(problems_.path()) : name;
  }

  /// Returns the step in s. The number in volume 2's header is more exact than those in text.
  double step(std::string_view line) const {
    if (step_s_ > 0) return step_s_;
    const auto named = step_named_in(line);
    if (header_->corrected) return header_->real(CsmipReal::step_s).value_or(named.value_or(0));
    const auto rate = step_named_in(header_->at(CsmipLine::points));
    return rate ? *rate : named.value_or(0);
  }

  std::string treatment() const {
    std::string out = header_->corrected ? "corrected" : "uncorrected";
    const auto low_hz = header_->real(CsmipReal::low_hz),
               high_hz = header_->real(CsmipReal::high_hz);
    if (low_hz && high_hz) out += fmt::format(", {:.3g} to {:g} Hz kept", *low_hz, *high_hz);
    return out + "; not used from the header: coordinates, event, the sensor's natural frequency";
  }

  /// Returns the start in UTC, from "Start time:  8/24/14, 10:20:33.0 UTC (GPS)" or "Trigger time:
  /// ...": month, day, year. Returns nullopt when the header does not state it.
  std::optional<double> start() {
    const std::string& line = header_->at(CsmipLine::start);
    std::string_view words = after(line, "time:");
    if (words.empty()) return std::nullopt;
    const std::int64_t at =
        header_->line + static_cast<std::int64_t>(CsmipLine::start) + (header_->corrected ? 1 : 0);
    std::array<double, 6> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto number = parse_number(up_to(words, i + 1 < numbers.size() ? "/-,: " : " "));
      if (!number || !(*number >= 0 && *number < 1e4))
        return problems_.add(at, fmt::format("CSMIP: {} is not a time", show_text(line)));
      numbers[i] = *number;
      const std::size_t end = words.find_first_of(i + 1 < numbers.size() ? "/-,: " : " ");
      words = end == std::string_view::npos ? "" : words.substr(end);
      words = trimmed(words.substr(std::min(words.size(), words.find_first_not_of("/-,: "))));
    }
    const auto [month, day, year, hour, minute, second] = numbers;
    constexpr double kFirstYear = 33;  ///< of two digits: 1933, the first accelerograms
    const double century = year >= 100 ? 0 : year >= kFirstYear ? 1900 : 2000;
    const auto local_s = utc_of(utc_of_date(static_cast<int>(year + century),
                                            static_cast<int>(month), static_cast<int>(day)),
                                hour, minute, second);
    if (!local_s)
      return problems_.add(at, fmt::format("CSMIP: {} is not a valid time", show_text(line)));
    return zoned(*local_s, up_to(words, " ("), at);
  }

  std::optional<double> zoned(double local_s, std::string_view zone, std::int64_t at) {
    constexpr double kHour_s = 3600;
    const std::pair<std::string_view, double> kZones[] = {
        {"utc", 0}, {"gmt", 0}, {"pst", -8}, {"pdt", -7}};
    for (const auto& [known, hours] : kZones) {
      if (zone != known) continue;
      if (!options_.zone_min) return local_s - hours * kHour_s;
      return problems_.add(at, "CSMIP: the header states its zone: --zone does not apply");
    }
    if (options_.zone_min) return local_s - 60.0 * *options_.zone_min;
    return problems_.add(at, fmt::format("CSMIP: the zone {} of the start is unknown: declare it "
                                         "with --zone Z or, for example, --zone +09:00",
                                         show_text(zone)));
  }

  static constexpr double kUnknown = -999;
  const RecordOptions& options_;
  FileProblems& problems_;
  LineReader lines_;
  std::optional<CsmipHeader> header_;
  double step_s_ = 0;  ///< of pairs; 0 for other values
  int left_out_ = 0;
};

}  // namespace

bool is_csmip_title(std::string_view first_line) {
  const std::string line = lower(first_line);
  return line.starts_with(kVolume1) || line.starts_with(kVolume2) || line.starts_with(kVolume3);
}

std::optional<Record> read_csmip(const RecordOptions& options, FileProblems& problems) {
  return merge_channels(CsmipReader(options, problems).read(), problems);
}

}  // namespace framewatch::drivers
