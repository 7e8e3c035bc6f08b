#include <fmt/core.h>

#include "drivers/base/line_reader.h"
#include "drivers/base/number_text.h"
#include "drivers/records/record_builder.h"
#include "drivers/records/record_formats.h"

namespace framewatch::drivers {

std::optional<Record> read_two_columns(AccelUnit unit, FileProblems& problems) {
  LineReader lines(problems);
  RecordBuilder builder({name_of_file(problems.path())}, problems);
  std::vector<std::string_view> fields;
  for (std::string_view line; lines.next(line) && !problems.full() && !builder.full();) {
    split_blanks(line, fields);
    if (fields.empty() || fields.front().front() == '#') continue;
    if (fields.size() != 2) {
      problems.add(lines.number(),
                   fmt::format("{} values where time and acceleration belong", fields.size()));
      continue;
    }
    const auto time_s = parse_number(fields[0]);
    const auto value = parse_sample(fields[1]);
    if (!time_s)
      problems.add(lines.number(), fmt::format("time {}: no number", show_text(fields[0])));
    if (!value)
      problems.add(lines.number(),
                   fmt::format("{} is neither a finite number nor nan", show_text(fields[1])));
    if (!time_s || !value) continue;
    const double accel_mps2 = *value * mps2_per(unit);
    builder.add(lines.number(), *time_s, {&accel_mps2, 1});
  }
  return builder.finish();
}

}  // namespace framewatch::drivers
