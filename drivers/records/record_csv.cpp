#include <fmt/core.h>

#include "drivers/base/line_reader.h"
#include "drivers/base/number_text.h"
#include "drivers/records/record_builder.h"
#include "drivers/records/record_formats.h"

namespace framewatch::drivers {
namespace {

/// Empty when the file ends before it.
std::optional<std::vector<std::string>> read_header(LineReader& lines, FileProblems& problems) {
  std::string_view line;
  while (lines.next(line))
    if (!trimmed(line).empty() && line.front() != '#') break;
  if (problems.any()) return std::nullopt;
  std::vector<std::string_view> fields;
  split_commas(line, fields);
  if (fields.front() != "time_s")
    problems.add(lines.number(),
                 fmt::format("the header must be time_s,<channel names>, not {}", show_text(line)));
  else if (fields.size() < 2)
    problems.add(lines.number(), "the header names no channel");
  const std::vector<std::string> names(fields.begin() + 1, fields.end());
  check_names(names, lines.number(), problems);
  return names;
}

}  // namespace

std::optional<Record> read_csv(FileProblems& problems) {
  LineReader lines(problems);
  const auto names = read_header(lines, problems);
  if (!names || problems.any()) return std::nullopt;

  RecordBuilder builder(*names, problems);
  std::vector<std::string_view> fields;
  std::vector<double> row(names->size());
  for (std::string_view line; lines.next(line) && !problems.full() && !builder.full();) {
    if (trimmed(line).empty()) continue;
    if (!lines.line_ended()) {
      builder.note(fmt::format("line {}: the last row has no line end and may be cut off: left out",
                               lines.number()));
      continue;
    }
    split_commas(line, fields);
    if (fields.size() != row.size() + 1) {
      problems.add(lines.number(),
                   fmt::format("{} fields where the header has {}", fields.size(), row.size() + 1));
      continue;
    }
    const auto time_s = parse_number(fields[0]);
    if (!time_s)
      problems.add(lines.number(), fmt::format("time {}: no number", show_text(fields[0])));
    bool sound = time_s.has_value();
    for (std::size_t i = 0; i < row.size(); ++i) {
      const auto value = parse_sample(fields[i + 1]);
      if (!value)
        problems.add(lines.number(), fmt::format("{}: {} is neither a finite number nor nan",
                                                 (*names)[i], show_text(fields[i + 1])));
      sound = sound && value;
      row[i] = value.value_or(0);
    }
    if (sound) builder.add(lines.number(), *time_s, row);
  }
  return builder.finish();
}

}  // namespace framewatch::drivers
