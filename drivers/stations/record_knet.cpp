// SPDX-License-Identifier: MIT
// Strong motion of Japan's K-NET and KiK-net (NIED): 17 lines of names and values, then whole
// numbers. https://www.kyoshin.bosai.go.jp/kyoshin/man/knetform_en.html
#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/core.h>

#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "drivers/records/record_builder.h"
#include "drivers/records/unit_text.h"
#include "drivers/stations/station_channel.h"
#include "drivers/stations/station_formats.h"

namespace framewatch::drivers {
namespace {

constexpr int kKnetHeaderLines = 17;
constexpr std::size_t kKnetTitleWidth = 18;  ///< "Sampling Freq(Hz) 100Hz"
/// The header gives the time of the trigger; the record begins this long before it.
constexpr double kBeforeTrigger_s = 15;
constexpr double kAheadOfUtc_s = 9 * 3600;

struct KnetLine {
  std::int64_t line = 0;
  std::string text;
};

class KnetReader {
 public:
  explicit KnetReader(FileProblems& problems) : problems_(problems), lines_(problems) {}

  std::optional<Record> read() {
    if (!read_header()) return std::nullopt;
    StationChannel channel;
    const double rate_hz = number_before("Sampling Freq", "Hz");
    const double unit_mps2 = scale();
    channel.start_utc_s = start();
    channel.header = direction(channel.name);
    channel.treatment = "uncorrected; not used from the header: coordinates, event";
    if (!problems_.any() && !(rate_hz > 0 && rate_hz <= RecordBuilder::kMaxRateHz))
      complain("Sampling Freq", "must be a rate");
    if (problems_.any()) return std::nullopt;
    channel.step_s = 1 / rate_hz;
    std::vector<double> accel_mps2;
    std::vector<std::string_view> fields;
    std::size_t per_line = 0;
    for (std::string_view line; !problems_.any() && lines_.next(line);) {
      split_blanks(line, fields);
      per_line = std::max(per_line, fields.size());
      for (const std::string_view field : fields) {
        const auto count = parse_integer(field);
        if (!count)
          problems_.add(lines_.number(),
                        fmt::format("K-NET: {} is not a whole number", show_text(field)));
        accel_mps2.push_back(static_cast<double>(count.value_or(0)) * unit_mps2);
        if (accel_mps2.size() > RecordBuilder::kMaxValues)
          problems_.add(lines_.number(), fmt::format("K-NET: a record holds at most {} values",
                                                     RecordBuilder::kMaxValues));
        if (problems_.any()) return std::nullopt;
      }
    }
    if (problems_.any()) return std::nullopt;
    const bool unended = !lines_.line_ended() && !accel_mps2.empty();
    if (unended) {
      accel_mps2.pop_back();
      channel.treatment += "; " + lines_.left_out_note("number");
    }
    const std::size_t left_out = unended ? 1 : 0;
    check_duration(rate_hz, accel_mps2.size() + left_out, channel.treatment);
    if (problems_.any()) return std::nullopt;
    return station_record(channel, accel_mps2, kKnetHeaderLines + 1,
                          std::max<std::size_t>(1, per_line), problems_);
  }

 private:
  bool read_header() {
    std::string_view line;
    while (lines_.number() < kKnetHeaderLines && lines_.next(line)) {
      const std::string_view title = trimmed(line.substr(0, kKnetTitleWidth));
      const std::string_view text =
          line.size() > kKnetTitleWidth ? trimmed(line.substr(kKnetTitleWidth)) : "";
      header_.insert({std::string(title), {lines_.number(), std::string(text)}});
    }
    if (lines_.number() < kKnetHeaderLines && !problems_.any())
      problems_.add(0, "K-NET: the header has fewer than 17 lines");
    return !problems_.any();
  }

  /// Returns the header line whose title begins with `title`. Adds a problem when there is no such
  /// line.
  KnetLine find(const std::string& title) {
    const auto at = header_.lower_bound(title);
    if (at != header_.end() && at->first.starts_with(title)) return at->second;
    problems_.add(0, fmt::format("K-NET: the header has no {}", title));
    return {};
  }

  void complain(const std::string& title, const std::string& rule) {
    const KnetLine at = find(title);
    problems_.add(at.line, fmt::format("K-NET: {} {} {}", title, show_text(at.text), rule));
  }

  double number_before(const std::string& title, std::string_view unit) {
    const std::string text = find(title).text;
    const auto value = parse_number(trimmed(std::string_view(text).substr(0, text.find(unit))));
    if (!value && !problems_.any()) complain(title, "must be a number");
    return value.value_or(0);
  }

  /// Reports fewer samples than the header's duration has: the file is cut off. Appends more of
  /// them to `treatment`.
  void check_duration(double rate_hz, std::size_t samples, std::string& treatment) {
    const double duration_s = number_before("Duration Time", "s");
    const double stated = std::round(duration_s * rate_hz);
    if (static_cast<double>(samples) < stated)
      complain("Duration Time",
               fmt::format("are {:.0f} samples at {:g} Hz, but the file has {}: it "
                           "is cut off",
                           stated, rate_hz, samples));
    else if (static_cast<double>(samples) > stated)
      treatment += fmt::format("; {} samples, the header's duration has {:.0f}", samples, stated);
  }

  /// Returns the m/s^2 of one count, from "3920(gal)/6182761".
  double scale() {
    const std::string text = find("Scale Factor").text;
    const std::size_t unit = text.find("(gal)/");
    const auto above = parse_number(std::string_view(text).substr(0, unit));
    const auto below = unit == std::string::npos
                           ? std::nullopt
                           : parse_number(std::string_view(text).substr(unit + 6));
    if (above && below && *above > 0 && *below > 0) return *above / *below * kGal_mps2;
    if (!problems_.any()) complain("Scale Factor", "must be such as 3920(gal)/6182761");
    return 0;
  }

  /// Returns the time of the first sample since 1970, from "2018/11/30 17:29:21" in Japan's time.
  std::optional<double> start() {
    std::string text = find("Record Time").text;
    for (char& c : text)
      if (c == '/') c = '-';
    const auto stamp = parse_time_stamp(text);
    if (!stamp && !problems_.any()) complain("Record Time", "is not a time");
    if (!stamp) return std::nullopt;
    return stamp->local_s - kAheadOfUtc_s - kBeforeTrigger_s;
  }

  /// Reads the direction and sets `name`. K-NET names directions, KiK-net numbers them: 1 to 3 in
  /// the borehole, 4 to 6 at the surface.
  AxisHeader direction(std::string& name) {
    const std::string dir = find("Dir.").text, station = find("Station Code").text;
    constexpr double kNorth = 0, kEast = 90, kUp = -1;
    struct Direction {
      const char *in_file, *channel, *place;
      double azimuth_deg;
    };
    constexpr Direction kDirections[] = {{"N-S", "NS", "", kNorth},
                                         {"E-W", "EW", "", kEast},
                                         {"U-D", "UD", "", kUp},
                                         {"1", "NS1", "in the borehole", kNorth},
                                         {"2", "EW1", "in the borehole", kEast},
                                         {"3", "UD1", "in the borehole", kUp},
                                         {"4", "NS2", "at the surface", kNorth},
                                         {"5", "EW2", "at the surface", kEast},
                                         {"6", "UD2", "at the surface", kUp}};
    for (const Direction& known : kDirections) {
      if (dir != known.in_file) continue;
      name = fmt::format("{}.{}", station, known.channel);
      AxisHeader header;
      header.place = known.place;
      header.unit = "gal";
      header.elevation_deg = known.azimuth_deg == kUp ? 90 : 0;
      if (known.azimuth_deg != kUp) header.azimuth_deg = known.azimuth_deg;
      return header;
    }
    if (!problems_.any()) complain("Dir.", "must be N-S, E-W, U-D or 1 to 6");
    return {};
  }

  FileProblems& problems_;
  LineReader lines_;
  std::map<std::string, KnetLine> header_;
};

}  // namespace

std::optional<Record> read_knet(FileProblems& problems) {
  return KnetReader(problems).read();
}

}  // namespace framewatch::drivers
