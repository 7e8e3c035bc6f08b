// Strong motion as COSMOS networks publish it (CESMD, USGS, CGS), format v1.20: raw counts (V0),
// uncorrected (V1) and corrected (V2) acceleration, one channel a file (V1c) or several.
// COSMOS Strong-Motion Programs Board (2001), "COSMOS strong motion data format", tables of 2015.
#include <array>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "drivers/records/accel_unit.h"
#include "drivers/records/record_builder.h"
#include "drivers/records/record_merge.h"
#include "drivers/records/time_text.h"
#include "drivers/stations/cosmos_header.h"
#include "drivers/stations/fortran_numbers.h"
#include "drivers/stations/station_channel.h"
#include "drivers/stations/station_formats.h"

namespace framewatch::drivers {
namespace {

constexpr double kMicro = 1e-6;

constexpr int kCounts = 50;

/// m/s2 of one of the file's units (table 2 of the format); empty for what is no acceleration.
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

/// Directions beside an azimuth (table 6 of the format).
std::string direction_words(int code) {
  constexpr std::array<std::pair<int, const char*>, 7> kWords = {{
      {402, "vertical, up or down is not said"},
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

/// Direction, place and unit; `direction` in words where the fields do not say it.
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
    direction = fmt::format("{:g} deg from an axis whose azimuth is not said", *value);
  if (out.azimuth_deg) out.elevation_deg = 0;
  return out;
}

std::string stage_text(const CosmosHeader& header, double unit_mps2) {
  const int stage = static_cast<int>(header.integer(CosmosInteger::stage).value_or(-1));
  if (stage == 0) return fmt::format("raw, {:.6g} m/s2 a count", unit_mps2);
  if (stage == 1) return "uncorrected";
  const auto low_hz = header.real(CosmosReal::low_corner_hz),
             high_hz = header.real(CosmosReal::high_corner_hz);
  if (stage != 2) return "stage of processing not said";
  if (!low_hz || !high_hz) return "corrected";
  return fmt::format("corrected, {:g} to {:g} Hz kept", *low_hz, *high_hz);
}

std::string treatment_text(const CosmosHeader& header, double unit_mps2) {
  std::string text = stage_text(header, unit_mps2);
  const auto flag = header.integer(CosmosInteger::problem_flag);
  if (flag == 1) text += "; its network mended a fault of it";
  if (flag == 2) text += "; its network says it has a fault";
  text += "; not used of the header: coordinates, event";
  if (const auto sensor_hz = header.real(CosmosReal::sensor_hz); sensor_hz && *sensor_hz > 0)
    text += fmt::format(", the sensor's own {:.3g} Hz (damping {:.2g})", *sensor_hz,
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

  /// One record for each channel of the file.
  std::vector<Record> read() {
    std::vector<Record> records;
    for (std::string_view line; !problems_.any() && lines_.next(line);) {
      if (trimmed(line).empty() || holds(line, "End-of-data")) continue;
      if (holds(line, "(Format v")) {
        header_ = read_cosmos_header(lines_, line, problems_);
        continue;
      }
      if (auto record = read_values(line)) records.push_back(std::move(*record));
    }
    if (!problems_.any() && records.empty())
      problems_.add(0, "COSMOS: no acceleration in the file");
    if (left_out_ > 0 && !records.empty())
      records.front().notes.push_back("velocity and displacement in the file are left out");
    return records;
  }

 private:
  /// "42000 acceleration pts, approx 210 secs, units=cm/sec2(04),Format=(1E15.6)" and the values.
  std::optional<Record> read_values(std::string_view line) {
    const std::int64_t at = lines_.number();
    const auto count = parse_integer(first_word(trimmed(line)));
    const auto format = find_fortran_format(line);
    if (!header_ || !count || *count < 1 || !format || !holds(line, "pts")) {
      problems_.add(at, fmt::format("COSMOS: {} is neither a header nor the number and format of "
                                    "values",
                                    show_text(line)));
      return std::nullopt;
    }
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
      problems_.add(header_->line,
                    unit == kCounts
                        ? std::string("COSMOS: counts without the header's microvolts a "
                                      "count and volts per g")
                        : fmt::format("COSMOS: unit {} of the header is no "
                                      "acceleration that is known",
                                      unit));
    if (!(step_s > 0)) problems_.add(header_->line, "COSMOS: the header has no step of time");
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
    if (!utc_s) {
      problems_.add(header_->line, "COSMOS: the header's start is no time");
      return std::nullopt;
    }
    const std::string_view said = after(*header_, "start time:");
    const bool utc = holds(said, "UTC") || holds(said, "GMT");
    if (utc && options_.zone_min)
      problems_.add(header_->line,
                    "COSMOS: the header says its zone itself: --zone does not apply");
    if (!utc && !options_.zone_min) {
      problems_.add(header_->line,
                    "COSMOS: the header does not say the zone of its start: declare "
                    "it with --zone Z or, for example, --zone +09:00");
      return std::nullopt;
    }
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
  std::vector<Record> records = CosmosReader(options, problems).read();
  if (problems.any()) return std::nullopt;
  if (records.size() == 1) return std::move(records.front());
  std::vector<Problem> found;
  const std::vector<std::string> where(records.size(), problems.path());
  auto merged = merge_records(std::move(records), where, MergeSpan::common, found);
  for (const Problem& problem : found) problems.add(0, problem.message);
  return merged;
}

}  // namespace framewatch::drivers
