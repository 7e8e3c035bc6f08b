// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/core.h>

#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "drivers/formats/record_formats.h"
#include "drivers/records/record_builder.h"
#include "drivers/records/unit_text.h"

namespace framewatch::drivers {
namespace {

struct At2Header {
  std::int64_t points = 0;
  double step_s = 0;
};

std::string upper(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return result;
}

/// Parses "NPTS= 4096, DT= .0100 SEC", "NPTS=4096 DT=0.01" or "4096 0.0100 NPTS, DT": the first
/// whole number is the count and the next number the step, in any order of the words. Returns
/// nullopt for other lines.
std::optional<At2Header> parse_counts(const std::string& line) {
  if (line.find("NPTS") == std::string::npos || line.find("DT") == std::string::npos)
    return std::nullopt;
  std::string plain = line;
  std::replace(plain.begin(), plain.end(), '=', ' ');
  std::vector<std::string_view> fields;
  split_blanks(plain, fields);
  At2Header header;
  for (const std::string_view field : fields) {
    if (header.points == 0)
      header.points = parse_integer(field).value_or(0);
    else if (header.step_s == 0)
      header.step_s = parse_number(field).value_or(0);
  }
  if (header.points < 1 || !(header.step_s > 0)) return std::nullopt;
  return header;
}

std::optional<At2Header> read_at2_header(LineReader& lines, FileProblems& problems) {
  std::array<std::string, 4> header;
  for (std::string& kept : header) {
    std::string_view line;
    if (!lines.next(line)) {
      if (!problems.any()) problems.add(0, "AT2: the file has fewer than four header lines");
      return std::nullopt;
    }
    kept = upper(line);
  }
  if (header[2].find("UNITS OF G") == std::string::npos ||
      header[2].find("ACCELERATION") == std::string::npos)
    problems.add(3,
                 fmt::format("AT2: the third line must name an acceleration in units of g, not {}",
                             show_text(header[2])));
  const auto counts = parse_counts(header[3]);
  if (!counts)
    problems.add(
        4, fmt::format("AT2: the fourth line must give NPTS and DT, not {}", show_text(header[3])));
  return counts;
}

/// Splits fields such as "-.123E-02-.456E-02": a sign begins the next number unless it follows an
/// E or D.
void split_stuck(std::string_view line, std::vector<std::string_view>& fields) {
  std::vector<std::string_view> blanks;
  split_blanks(line, blanks);
  fields.clear();
  for (std::string_view field : blanks) {
    for (std::size_t i = 1; i < field.size();) {
      const bool begins =
          field[i] == '-' && std::string_view("EeDd").find(field[i - 1]) == std::string_view::npos;
      if (begins) {
        fields.push_back(field.substr(0, i));
        field.remove_prefix(i);
      }
      i = begins ? 1 : i + 1;
    }
    fields.push_back(field);
  }
}

}  // namespace

std::optional<Record> read_at2(FileProblems& problems) {
  LineReader lines(problems);
  const auto header = read_at2_header(lines, problems);
  if (!header) return std::nullopt;
  RecordBuilder builder({name_of_file(problems.path())}, problems);
  std::vector<std::string_view> fields;
  std::int64_t count = 0, left_out = 0;
  for (std::string_view line; lines.next(line) && !problems.full() && !builder.full();) {
    split_stuck(line, fields);
    if (!lines.line_ended() && !fields.empty()) {
      builder.note(lines.left_out_note("number"));
      fields.pop_back();
      left_out = 1;
    }
    for (const std::string_view field : fields) {
      const auto value = parse_sample(field);
      if (!value)
        problems.add(lines.number(),
                     fmt::format("{} is neither a finite number nor nan", show_text(field)));
      const double accel_mps2 = value.value_or(0) * kStandardGravity_mps2;
      builder.add(lines.number(), static_cast<double>(count++) * header->step_s, {&accel_mps2, 1});
    }
  }
  if (!problems.any() && count + left_out != header->points)
    problems.add(4, fmt::format("AT2: NPTS is {} but the file holds {} values", header->points,
                                count + left_out));
  return builder.finish();
}

}  // namespace framewatch::drivers
