// SPDX-License-Identifier: MIT
// Numbers without a header: columns of time and channels, or one channel that goes on line after
// line.
#include <fmt/core.h>

#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "drivers/formats/record_formats.h"
#include "drivers/records/record_builder.h"

namespace framewatch::drivers {
namespace {

/// Begins the line that closes some of these files, "*** End Data ***".
constexpr std::string_view kEndMark = "***";

/// Returns the file's name for one channel, and numbered names for several.
std::vector<std::string> names_of_columns(const std::string& path, std::size_t channels) {
  std::vector<std::string> names{name_of_file(path)};
  if (channels == 1) return names;
  const std::string name = names[0];
  names.clear();
  for (std::size_t i = 0; i < channels; ++i) names.push_back(fmt::format("{}.{}", name, i + 1));
  return names;
}

}  // namespace

std::optional<Record> read_columns(double unit_mps2, FileProblems& problems) {
  LineReader lines(problems);
  std::optional<RecordBuilder> builder;
  std::vector<std::string_view> fields;
  std::vector<double> row;
  for (std::string_view line;
       lines.next(line) && !problems.full() && !(builder && builder->full());) {
    split_blanks(line, fields);
    if (fields.empty() || fields.front().front() == '#') continue;
    if (builder && !lines.line_ended()) {
      builder->note(lines.left_out_note("row"));
      continue;
    }
    if (!builder && fields.size() < 2) {
      problems.add(lines.number(), "a row needs a time and an acceleration, but has one value");
      break;
    }
    if (!builder) {
      row.resize(fields.size() - 1);
      builder.emplace(names_of_columns(problems.path(), row.size()), problems);
    }
    if (fields.size() != row.size() + 1) {
      problems.add(lines.number(), fmt::format("{} values where the first row has {}",
                                               fields.size(), row.size() + 1));
      continue;
    }
    const auto time_s = parse_number(fields[0]);
    if (!time_s)
      problems.add(lines.number(), fmt::format("time {}: not a number", show_text(fields[0])));
    bool sound = time_s.has_value();
    for (std::size_t i = 0; i < row.size(); ++i) {
      const auto value = parse_sample(fields[i + 1]);
      if (!value)
        problems.add(lines.number(), fmt::format("column {}: {} is neither a finite number nor nan",
                                                 i + 2, show_text(fields[i + 1])));
      sound = sound && value;
      row[i] = value.value_or(0) * unit_mps2;
    }
    if (sound) builder->add(lines.number(), *time_s, row);
  }
  if (builder) return builder->finish();
  if (!problems.any()) problems.add(0, "there are no rows");
  return std::nullopt;
}

std::optional<Record> read_rows(double unit_mps2, double step_s, FileProblems& problems) {
  LineReader lines(problems);
  RecordBuilder builder({name_of_file(problems.path())}, problems);
  std::vector<std::string_view> fields;
  std::size_t width = 0;
  std::int64_t short_line = 0;
  bool ended = false;
  double count = 0;
  for (std::string_view line; lines.next(line) && !problems.full() && !builder.full();) {
    split_blanks(line, fields);
    if (fields.empty() || fields.front().front() == '#') continue;
    if (ended) {
      problems.add(lines.number(), "there are more rows after the line that ends the data");
      break;
    }
    ended = width > 0 && line.substr(0, kEndMark.size()) == kEndMark;
    if (ended) continue;
    if (width == 0) width = fields.size();
    if (short_line > 0 || fields.size() > width)
      problems.add(
          short_line > 0 ? short_line : lines.number(),
          fmt::format("ragged: the first row has {} values, only the last may have fewer", width));
    short_line = fields.size() < width ? lines.number() : 0;
    if (!lines.line_ended()) {
      builder.note(lines.left_out_note("number"));
      fields.pop_back();
    }
    for (const std::string_view field : fields) {
      const auto value = parse_sample(field);
      if (!value)
        problems.add(lines.number(),
                     fmt::format("{} is neither a finite number nor nan", show_text(field)));
      const double accel_mps2 = value.value_or(0) * unit_mps2;
      builder.add(lines.number(), count++ * step_s, {&accel_mps2, 1});
    }
  }
  return builder.finish();
}

}  // namespace framewatch::drivers
