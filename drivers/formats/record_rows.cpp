#include <fmt/core.h>

#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "drivers/formats/record_formats.h"
#include "drivers/records/record_builder.h"

namespace framewatch::drivers {
namespace {

/// Of the line that closes some of these files: "*** End Data ***".
constexpr std::string_view kEndMark = "***";

}  // namespace

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
      problems.add(lines.number(), "there is more after the line that ends the data");
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
