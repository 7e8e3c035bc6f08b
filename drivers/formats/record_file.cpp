// SPDX-License-Identifier: MIT
#include "drivers/formats/record_file.h"

#include <libmseed.h>

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <fmt/format.h>

#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "drivers/files/packed_file.h"
#include "drivers/formats/mat_variables.h"
#include "drivers/formats/record_formats.h"
#include "drivers/formats/table.h"
#include "drivers/formats/unread_formats.h"
#include "drivers/records/record_builder.h"
#include "drivers/stations/station_formats.h"

namespace framewatch::drivers {
namespace {

std::string bytes_of(FileProblems& problems) {
  GzipInput file(problems.path());
  std::string head(kHeadBytes, '\0');
  const std::int64_t got = file.read(head.data(), std::ssize(head));
  if (!file.error().empty()) problems.add(0, file.error());
  head.resize(static_cast<std::size_t>(std::max<std::int64_t>(got, 0)));
  return head;
}

/// Returns the format of a binary file by its first bytes; nullopt when the file may be text. A
/// known format that is not supported becomes a problem that says what to do.
std::optional<RecordFormat> format_by_signature(FileProblems& problems) {
  const std::string head = bytes_of(problems);
  if (mat_level(head) != MatLevel::none) return RecordFormat::mat;
  if (head.size() >= 48 && MS_ISVALIDHEADER(head.data())) return RecordFormat::mseed;
  if (is_sac_header(head)) return RecordFormat::sac;
  const std::string unread = unread_format(head);
  if (!unread.empty()) problems.add(0, unread);
  return std::nullopt;
}

/// Lines read to find the format; the header of Xsens files is the eighth line.
constexpr std::int64_t kDetectLines = 20;

bool holds(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// Returns the format of numbers without a header. Two in a row are time and value, one is a
/// channel. More are one channel that goes on line after line if a row is shorter or the end is
/// marked; otherwise they could also be channels, which is a problem.
RecordFormat format_of_numbers(std::int64_t first_line, std::size_t width, FileProblems& problems) {
  if (width <= 2) return width == 2 ? RecordFormat::columns : RecordFormat::rows;
  LineReader lines(problems);
  std::vector<std::string_view> fields;
  for (std::string_view line; lines.next(line);) {
    split_blanks(line, fields);
    if (lines.number() <= first_line || fields.empty() || fields.front().front() == '#') continue;
    if (fields.size() != width || !parse_sample(fields.front())) return RecordFormat::rows;
  }
  if (!problems.any())
    problems.add(first_line,
                 fmt::format("{} numbers in every row, without a header, can be read in two ways: "
                             "as columns (write a header line such as time_s,a,b above them, or "
                             "--format columns: time, then channels) or as one channel that goes "
                             "on line after line (--format rows --step)",
                             width));
  return RecordFormat::detect;
}

/// Returns the format of a network's file by its first line; detect when it has another format.
RecordFormat format_of_network(std::string_view first_line) {
  if (holds(first_line, "(Format v")) return RecordFormat::cosmos;
  if (first_line.starts_with("Origin Time")) return RecordFormat::knet;
  if (is_geonet_title(first_line)) return RecordFormat::geonet;
  if (is_csmip_title(first_line)) return RecordFormat::csmip;
  if (is_esm_title(first_line)) return RecordFormat::esm;
  return is_smc_title(first_line) ? RecordFormat::smc : RecordFormat::detect;
}

RecordFormat detect(const RecordOptions& options, FileProblems& problems) {
  if (const auto binary = format_by_signature(problems)) return *binary;
  if (problems.any()) return RecordFormat::detect;
  LineReader lines(problems);
  std::vector<std::string_view> fields;
  std::size_t width = 0;  // numbers in the first row
  std::int64_t first_line = 0;
  bool text = false;  // there is text above that row
  for (std::string_view line; lines.number() < kDetectLines && lines.next(line);) {
    if (lines.number() == 1 && format_of_network(line) != RecordFormat::detect)
      return format_of_network(line);
    if (holds(line, "PacketCounter") && holds(line, "SampleTimeFine")) return RecordFormat::xsens;
    if (lines.number() <= 4 && holds(line, "NPTS")) return RecordFormat::at2;
    line = without_header_mark(line);
    if (is_comment(line, '\0') || width > 0) continue;
    if (is_toa5(line) || is_table_header(line, options)) return RecordFormat::csv;
    // A line of text may be the header of an AT2 or Xsens file: read on.
    split_blanks(line, fields);
    const auto cells = split_cells(line, delimiter_of(line));
    if (cells && begins_data(cells->front())) {
      width = std::max<std::size_t>(1, fields.size());
      first_line = lines.number();
    } else {
      text = true;
    }
  }
  if (problems.any()) return RecordFormat::detect;
  if (lines.number() == 0)
    problems.add(0, "the file is empty");
  else if (width == 0)
    problems.add(
        0,
        "no known record format: not a table with a header such as time_s,<channel names>, "
        "not what a strong-motion network publishes (COSMOS, CSMIP, SMC, K-NET, ESM, GeoNet, SAC, "
        "miniSEED 2), not PEER AT2, not Xsens DOT, not MATLAB, not rows of numbers");
  else
    return text ? RecordFormat::csv : format_of_numbers(first_line, width, problems);
  return RecordFormat::detect;
}

/// Reports missing options that the format needs, and options that do not apply to it.
void check_declared(RecordFormat format, const RecordOptions& options, FileProblems& problems) {
  const bool of_station = format == RecordFormat::mseed || format == RecordFormat::sac;
  const bool needs_unit =
      format == RecordFormat::columns || format == RecordFormat::rows || of_station;
  const bool needs_step = format == RecordFormat::rows;
  if (of_station && options.unit_mps2 && !options.station_xml.empty())
    problems.add(0, "--unit and --station-xml both say what a count is: leave one out");
  if (needs_unit && !options.unit_mps2 && (!of_station || options.station_xml.empty()))
    problems.add(0,
                 format == RecordFormat::mseed
                     ? "a miniSEED file does not say what a count is: declare it with --unit, "
                       "the m/s^2 of one, for example --unit 1e-6, or give its network's "
                       "StationXML with --station-xml"
                     : "the file does not say its unit: declare it with --unit g, mg, gal or mps2");
  if (!needs_unit && options.unit_mps2)
    problems.add(0, "the format has its own unit: --unit does not apply");
  if (needs_step && !options.step_s)
    problems.add(0, "the file has no time: declare the step in seconds, for example --step 0.01");
  if (!needs_step && options.step_s)
    problems.add(0, "the file has its own time: --step does not apply");
  if (!options.time_column.empty() || options.time_unit_s || options.decimal)
    problems.add(0, "--time, --time-unit and --decimal are for tables with a header");
  if (options.zone_min && format != RecordFormat::cosmos && format != RecordFormat::csmip)
    problems.add(0, "--zone is for tables with a header, COSMOS and CSMIP");
  if (!options.columns.empty() && format != RecordFormat::mseed)
    problems.add(0, "--columns is for tables with a header, MATLAB files and miniSEED");
}

void give_names(const std::vector<std::string>& names, Record& record, FileProblems& problems) {
  if (names.empty()) return;
  if (names.size() != record.names.size()) {
    problems.add(0, fmt::format("--names gives {} names, the file has {} channels", names.size(),
                                record.names.size()));
    return;
  }
  check_names(names, 0, problems);
  record.names = names;
}

std::optional<Record> read_as(RecordFormat format, const RecordOptions& options,
                              FileProblems& problems) {
  const bool table = format == RecordFormat::csv || format == RecordFormat::mat;
  if (!table) check_declared(format, options, problems);
  if (!options.station_xml.empty() && format != RecordFormat::mseed && format != RecordFormat::sac)
    problems.add(0, "--station-xml is for miniSEED and SAC");
  if (options.step_s && !(std::isfinite(*options.step_s) && *options.step_s > 0))
    problems.add(0, fmt::format("--step {} must be positive", *options.step_s));
  if (problems.any()) return std::nullopt;
  switch (format) {
    case RecordFormat::csv:
      return read_csv(options, problems);
    case RecordFormat::at2:
      return read_at2(problems);
    case RecordFormat::xsens:
      return read_xsens(problems);
    case RecordFormat::mseed:
      return read_mseed(options, problems);
    case RecordFormat::mat:
      return read_mat(options, problems);
    case RecordFormat::cosmos:
      return read_cosmos(options, problems);
    case RecordFormat::smc:
      return read_smc(problems);
    case RecordFormat::knet:
      return read_knet(problems);
    case RecordFormat::csmip:
      return read_csmip(options, problems);
    case RecordFormat::esm:
      return read_esm(problems);
    case RecordFormat::geonet:
      return read_geonet(problems);
    case RecordFormat::sac:
      return read_sac(options, problems);
    case RecordFormat::columns:
      return read_columns(*options.unit_mps2, problems);
    case RecordFormat::rows:
      return read_rows(*options.unit_mps2, *options.step_s, problems);
    case RecordFormat::detect:
      break;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Record> read_record(const std::string& path, const RecordOptions& options,
                                  std::vector<Problem>& all_problems) {
  FileProblems problems(path, all_problems);
  RecordFormat format = options.format;
  if (format == RecordFormat::detect) format = detect(options, problems);
  if (problems.any()) return std::nullopt;
  auto record = read_as(format, options, problems);
  if (record) give_names(options.names, *record, problems);
  if (problems.any()) return std::nullopt;
  return record;
}

bool is_network_file(const std::string& path) {
  std::vector<Problem> ignored;
  FileProblems problems(path, ignored);
  if (const auto binary = format_by_signature(problems))
    return *binary == RecordFormat::mseed || *binary == RecordFormat::sac;
  LineReader lines(problems);
  std::string_view line;
  return !problems.any() && lines.next(line) && format_of_network(line) != RecordFormat::detect;
}

}  // namespace framewatch::drivers
