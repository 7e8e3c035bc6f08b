#include "drivers/records/record_file.h"

#include <array>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "drivers/base/line_reader.h"
#include "drivers/base/number_text.h"
#include "drivers/records/record_formats.h"

namespace framewatch::drivers {
namespace {

constexpr std::array<std::pair<std::string_view, RecordFormat>, 6> kFormats = {{
    {"detect", RecordFormat::detect},
    {"csv", RecordFormat::csv},
    {"at2", RecordFormat::at2},
    {"two-columns", RecordFormat::two_columns},
    {"rows", RecordFormat::rows},
    {"xsens", RecordFormat::xsens},
}};

/// Lines that are read to find the format; the header of Xsens is the eighth.
constexpr std::int64_t kDetectLines = 20;

bool holds(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

RecordFormat detect(FileProblems& problems) {
  LineReader lines(problems);
  std::vector<std::string_view> fields;
  RecordFormat by_first_row = RecordFormat::detect;
  for (std::string_view line; lines.number() < kDetectLines && lines.next(line);) {
    if (holds(line, "PacketCounter") && holds(line, "SampleTimeFine")) return RecordFormat::xsens;
    if (lines.number() <= 4 && holds(line, "NPTS")) return RecordFormat::at2;
    split_blanks(line, fields);
    if (fields.empty() || fields.front().front() == '#' || by_first_row != RecordFormat::detect)
      continue;
    const bool numbers = parse_number(fields.front()).has_value();
    if (numbers) by_first_row = fields.size() == 2 ? RecordFormat::two_columns : RecordFormat::rows;
    if (fields.front() == "time_s") return RecordFormat::csv;
    // A line of text may be the header of an AT2 or Xsens file: read on.
  }
  if (problems.any()) return RecordFormat::detect;
  if (lines.number() == 0)
    problems.add(0, "the file is empty");
  else if (by_first_row == RecordFormat::detect)
    problems.add(0,
                 "no known record format: not a CSV with the header time_s,<channel names>, not "
                 "PEER AT2, not Xsens DOT, not rows of numbers");
  return by_first_row;
}

/// Reports options that the format needs and lacks, and those that do not apply to it.
void check_declared(RecordFormat format, const RecordOptions& options, FileProblems& problems) {
  const bool needs_unit = format == RecordFormat::two_columns || format == RecordFormat::rows;
  const bool needs_step = format == RecordFormat::rows;
  if (needs_unit && !options.unit)
    problems.add(0, "the file does not say its unit: declare it with --unit g, gal or mps2");
  if (!needs_unit && options.unit)
    problems.add(0, "the format has its own unit: --unit does not apply");
  if (needs_step && !options.step_s)
    problems.add(0, "the file has no time: declare the step in seconds, for example --step 0.01");
  if (needs_step && options.step_s && !(std::isfinite(*options.step_s) && *options.step_s > 0))
    problems.add(0, fmt::format("--step {} must be positive", *options.step_s));
  if (!needs_step && options.step_s)
    problems.add(0, "the file has its own time: --step does not apply");
}

}  // namespace

std::optional<RecordFormat> record_format(std::string_view name) {
  for (const auto& [known, format] : kFormats)
    if (known == name) return format;
  return std::nullopt;
}

std::optional<Record> read_record(const std::string& path, const RecordOptions& options,
                                  std::vector<Problem>& all_problems) {
  FileProblems problems(path, all_problems);
  RecordFormat format = options.format;
  if (format == RecordFormat::detect) format = detect(problems);
  if (problems.any()) return std::nullopt;
  check_declared(format, options, problems);
  if (problems.any()) return std::nullopt;
  switch (format) {
    case RecordFormat::csv:
      return read_csv(problems);
    case RecordFormat::at2:
      return read_at2(problems);
    case RecordFormat::xsens:
      return read_xsens(problems);
    case RecordFormat::two_columns:
      return read_two_columns(*options.unit, problems);
    case RecordFormat::rows:
      return read_rows(*options.unit, *options.step_s, problems);
    case RecordFormat::detect:
      break;
  }
  return std::nullopt;
}

}  // namespace framewatch::drivers
