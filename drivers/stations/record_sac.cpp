// Seismic Analysis Code, binary: one channel a file.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "drivers/files/packed_file.h"
#include "drivers/records/record_builder.h"
#include "drivers/stations/count_meanings.h"
#include "drivers/stations/sac_header.h"
#include "drivers/stations/station_channel.h"
#include "drivers/stations/station_formats.h"

namespace framewatch::drivers {
namespace {

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
  if (!utc_s || std::abs(millisecond) > 999) {
    problems.add(0, "SAC: the header's time is none");
    return std::nullopt;
  }
  return *utc_s + 1e-3 * millisecond + header.number(SacFloat::begin_s).value_or(0);
}

std::optional<std::vector<double>> read_values(GzipInput& file, const SacHeader& header,
                                               double unit_mps2, FileProblems& problems) {
  const auto points = static_cast<std::size_t>(header.integer(SacInteger::points).value_or(0));
  if (points > RecordBuilder::kMaxValues) {
    problems.add(0, fmt::format("a record holds at most {} values", RecordBuilder::kMaxValues));
    return std::nullopt;
  }
  std::vector<double> values;
  std::array<char, 4096> bytes{};
  while (values.size() < points) {
    const std::size_t wanted = std::min(bytes.size(), 4 * (points - values.size()));
    const std::int64_t got = file.read(bytes.data(), static_cast<std::int64_t>(wanted));
    if (got != static_cast<std::int64_t>(wanted)) {
      problems.add(0, !file.error().empty()
                          ? file.error()
                          : fmt::format("SAC: the header says {} values, the file ends before "
                                        "them",
                                        points));
      return std::nullopt;
    }
    for (std::size_t at = 0; at < wanted; at += 4)
      values.push_back(
          unit_mps2 * static_cast<double>(sac_value(bytes.data() + at, header.other_byte_order())));
  }
  return values;
}

}  // namespace

std::optional<Record> read_sac(const RecordOptions& options, FileProblems& problems) {
  GzipInput file(problems.path());
  std::string bytes(kSacHeaderBytes, '\0');
  const std::int64_t got = file.read(bytes.data(), std::ssize(bytes));
  const auto header = got == std::ssize(bytes) ? SacHeader::read(bytes) : std::nullopt;
  if (!header) {
    problems.add(0, file.error().empty() ? "is no SAC file of version 6 or 7" : file.error());
    return std::nullopt;
  }
  if (header->integer(SacInteger::file_type).value_or(kTimeSeries) != kTimeSeries ||
      header->integer(SacInteger::even).value_or(1) != 1)
    problems.add(0, "SAC: a spectrum or uneven steps, no time series");
  const int quantity = header->integer(SacInteger::quantity).value_or(0);
  if (quantity == kDisplacement || quantity == kVelocity)
    problems.add(0, "SAC: the header says a displacement or a velocity, no acceleration");
  const double step_s = header->number(SacFloat::step_s).value_or(0);
  if (step_s * RecordBuilder::kMaxRateHz < 1)
    problems.add(0, fmt::format("SAC: a step of {:g} s", step_s));
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
  channel.treatment = (meaning->note.empty() ? "times --unit" : meaning->note) +
                      "; not used of the header: coordinates, event, picks";
  return station_record(channel, *values, 0, values->size(), problems);
}

}  // namespace framewatch::drivers
