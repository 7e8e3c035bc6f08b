// SPDX-License-Identifier: MIT
// Strong motion of New Zealand's GeoNet (GNS Science), uncorrected (V1A) and corrected (V2A): for
// each component 16 lines of text, 40 whole numbers, 60 real numbers, accelerations in mm/s^2, and
// in V2A velocities and displacements.
// https://www.geonet.org.nz/data/supplementary/strong_motion_file_formats
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
#include "drivers/stations/fortran_numbers.h"
#include "drivers/stations/station_channel.h"
#include "drivers/stations/station_formats.h"

namespace framewatch::drivers {
namespace {

constexpr std::size_t kGeonetTextLines = 16, kGeonetIntegers = 40, kGeonetReals = 60;
constexpr FortranFormat kTenOfEight{10, 8};
constexpr double kMillimetre_m = 1e-3;

/// Places in the header of the texts and values that are read, counted from 0.
enum class GeonetLine : std::size_t { title = 0, site = 1, component = 12 };
enum class GeonetInteger : std::size_t {
  year = 8,
  month = 9,
  day = 18,
  hour = 19,
  accelerations = 33,
  velocities = 34,
  displacements = 35,
  minute = 38,
  millisecond = 39,
};
enum class GeonetReal : std::size_t {
  raw_step_s = 24,
  step_s = 25,
  raw_peak = 30,
  peak = 35,
  low_hz = 52,
  high_hz = 55,
};

struct GeonetHeader {
  std::int64_t line = 0;
  std::vector<std::string> text;
  std::vector<double> integers, reals;

  const std::string& at(GeonetLine field) const { return text[static_cast<std::size_t>(field)]; }
  double integer(GeonetInteger field) const { return integers[static_cast<std::size_t>(field)]; }
  double real(GeonetReal field) const { return reals[static_cast<std::size_t>(field)]; }
  bool corrected() const { return at(GeonetLine::title).starts_with("Corrected"); }
};

/// Returns word `i` of a text, counted from 0; empty when there are fewer.
std::string_view word_of(std::string_view text, std::size_t i) {
  std::vector<std::string_view> words;
  split_blanks(text, words);
  return i < words.size() ? words[i] : std::string_view();
}

/// Returns the azimuth of a bearing: N10E is 10, S14E 166, S75W 255, N5W 355. Returns nullopt for
/// any other text.
std::optional<double> azimuth_of(std::string_view bearing) {
  if (bearing.size() < 3) return std::nullopt;
  const char from = bearing.front(), to = bearing.back();
  const auto angle_deg = parse_number(bearing.substr(1, bearing.size() - 2));
  if ((from != 'N' && from != 'S') || (to != 'E' && to != 'W')) return std::nullopt;
  if (!angle_deg || !(*angle_deg >= 0 && *angle_deg <= 90)) return std::nullopt;
  const double from_deg = from == 'N' ? 0 : 180;
  const bool clockwise = (from == 'N') == (to == 'E');
  return std::fmod(360 + from_deg + (clockwise ? 1 : -1) * *angle_deg, 360);
}

class GeonetReader {
 public:
  explicit GeonetReader(FileProblems& problems) : problems_(problems), lines_(problems) {}

  /// Returns one record for each component of the file.
  std::vector<Record> read() {
    std::vector<Record> records;
    for (std::string_view line; !problems_.any() && lines_.next(line);) {
      if (trimmed(line).empty()) continue;
      if (!is_geonet_title(line)) {
        problems_.add(lines_.number(),
                      fmt::format("GeoNet: {} does not begin a component", show_text(line)));
        break;
      }
      const auto header = read_header(line);
      if (!header) break;
      auto record = read_component(*header);
      if (record) records.push_back(std::move(*record));
    }
    if (!problems_.any() && records.empty())
      problems_.add(0, "GeoNet: no acceleration in the file");
    if (left_out_ && !records.empty())
      records.front().notes.push_back("velocity and displacement in the file were left out");
    return records;
  }

 private:
  std::optional<GeonetHeader> read_header(std::string_view line) {
    GeonetHeader header;
    header.line = lines_.number();
    header.text.emplace_back(line);
    while (header.text.size() < kGeonetTextLines && lines_.next(line))
      header.text.emplace_back(line);
    if (header.text.size() < kGeonetTextLines) {
      if (!problems_.any())
        problems_.add(lines_.number(), fmt::format("GeoNet: only {} of {} lines of text",
                                                   header.text.size(), kGeonetTextLines));
      return std::nullopt;
    }
    auto integers = read_fortran_numbers(lines_, kTenOfEight, kGeonetIntegers,
                                         "GeoNet: whole numbers", problems_);
    if (!integers) return std::nullopt;
    auto reals =
        read_fortran_numbers(lines_, kTenOfEight, kGeonetReals, "GeoNet: real numbers", problems_);
    if (!reals) return std::nullopt;
    header.integers = std::move(*integers);
    header.reals = std::move(*reals);
    return header;
  }

  /// Returns one of the header's numbers of values. Adds a problem when it is impossible.
  std::size_t count(const GeonetHeader& header, GeonetInteger field, const char* what) {
    const double value = header.integer(field);
    if (value >= 0 && value <= static_cast<double>(RecordBuilder::kMaxValues))
      return static_cast<std::size_t>(value);
    problems_.add(header.line, fmt::format("GeoNet: {:g} {} are not possible", value, what));
    return 0;
  }

  std::optional<Record> read_component(const GeonetHeader& header) {
    const std::size_t points = count(header, GeonetInteger::accelerations, "accelerations"),
                      others = count(header, GeonetInteger::velocities, "velocities"),
                      last = count(header, GeonetInteger::displacements, "displacements");
    StationChannel channel = channel_of(header);
    if (points == 0 && !problems_.any())
      problems_.add(header.line, "GeoNet: the header has no number of accelerations");
    if (!(channel.step_s * RecordBuilder::kMaxRateHz >= 1) && !problems_.any())
      problems_.add(header.line, fmt::format("GeoNet: {:g} s is not a valid step", channel.step_s));
    if (problems_.any()) return std::nullopt;
    const std::int64_t line = lines_.number() + 1;
    auto values =
        read_fortran_numbers(lines_, kTenOfEight, points, "GeoNet: accelerations", problems_);
    for (const std::size_t left_out : {others, last}) {
      if (!values) return std::nullopt;
      if (left_out > 0 && !read_fortran_numbers(lines_, kTenOfEight, left_out,
                                                "GeoNet: velocities and displacements", problems_))
        return std::nullopt;
      left_out_ = left_out_ || left_out > 0;
    }
    for (double& value : *values) value *= kMillimetre_m;
    return station_record(channel, *values, line, kTenOfEight.per_line, problems_);
  }

  StationChannel channel_of(const GeonetHeader& header) {
    StationChannel out;
    const std::string_view component = word_of(header.at(GeonetLine::component), 1),
                           id = word_of(header.at(GeonetLine::title), 2);
    const std::size_t mark = id.rfind('_');
    out.name = fmt::format("NZ.{}.{}.{}", word_of(header.at(GeonetLine::site), 1),
                           mark == std::string_view::npos ? "" : id.substr(mark + 1), component);
    const double step_s = header.real(GeonetReal::step_s);
    out.step_s = step_s > 0 ? step_s : header.real(GeonetReal::raw_step_s);
    out.start_utc_s = start(header);
    const auto azimuth_deg = azimuth_of(component);
    if (component == "Up" || component == "Down")
      out.header.elevation_deg = component == "Up" ? 90 : -90;
    else if (azimuth_deg)
      out.header.azimuth_deg = azimuth_deg, out.header.elevation_deg = 0;
    else
      out.direction = fmt::format("component {}, azimuth unknown", show_text(component));
    out.header.unit = "mm/s2";
    out.treatment = "uncorrected";
    if (header.corrected())
      out.treatment =
          fmt::format("corrected, {:g} to {:g} Hz kept", header.real(GeonetReal::low_hz),
                      header.real(GeonetReal::high_hz));
    out.treatment += "; not used from the header: coordinates, event, the site's name";
    const double peak =
        header.real(header.corrected() ? GeonetReal::peak : GeonetReal::raw_peak) * kMillimetre_m;
    if (peak != 0) out.peak_mps2 = peak;
    return out;
  }

  std::optional<double> start(const GeonetHeader& header) {
    const double year = header.integer(GeonetInteger::year);
    if (year == 0) return std::nullopt;
    const auto whole = [&](GeonetInteger field) {
      const double value = header.integer(field);
      return value >= 0 && value < 1e4 ? static_cast<int>(value) : 0;
    };
    const auto utc_s =
        utc_of(utc_of_date(whole(GeonetInteger::year), whole(GeonetInteger::month),
                           whole(GeonetInteger::day)),
               header.integer(GeonetInteger::hour), header.integer(GeonetInteger::minute),
               1e-3 * header.integer(GeonetInteger::millisecond));
    if (!utc_s) problems_.add(header.line, "GeoNet: the header's start is not a valid time");
    return utc_s;
  }

  FileProblems& problems_;
  LineReader lines_;
  bool left_out_ = false;
};

}  // namespace

bool is_geonet_title(std::string_view first_line) {
  const bool title = first_line.starts_with("Uncorrected accelerogram") ||
                     first_line.starts_with("Corrected accelerogram");
  return title && first_line.find("GNS Science") != std::string_view::npos;
}

std::optional<Record> read_geonet(FileProblems& problems) {
  return merge_channels(GeonetReader(problems).read(), problems);
}

}  // namespace framewatch::drivers
