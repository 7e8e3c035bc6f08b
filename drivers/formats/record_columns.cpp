#include <fmt/core.h>

#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "drivers/formats/record_formats.h"
#include "drivers/records/record_builder.h"

namespace framewatch::drivers {
namespace {

/// One channel has the file's name, several have it with their number.
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
    if (!builder && fields.size() < 2) {
      problems.add(lines.number(), "one value a row where time and acceleration belong");
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
      problems.add(lines.number(), fmt::format("time {}: no number", show_text(fields[0])));
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

}  // namespace framewatch::drivers
