// SPDX-License-Identifier: MIT
#include "drivers/stations/fortran_numbers.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "drivers/files/number_text.h"
#include "drivers/records/record_builder.h"

namespace framewatch::drivers {
namespace {

constexpr std::string_view kDigits = "0123456789";

/// Removes the whole number at the beginning of `text` and returns it; 0 when there is no number.
std::size_t take_number(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_not_of(kDigits), text.size());
  const auto value = parse_integer(text.substr(0, end));
  text.remove_prefix(end);
  return value && *value > 0 && *value < 10'000 ? static_cast<std::size_t>(*value) : 0;
}

}  // namespace

std::optional<FortranFormat> find_fortran_format(std::string_view text) {
  text.remove_prefix(std::min(text.size(), text.find("ormat")));
  const std::size_t begin = text.find('(');
  if (begin == std::string_view::npos) return std::nullopt;
  text.remove_prefix(begin + 1);
  FortranFormat format;
  format.per_line = take_number(text);
  if (text.starts_with('P') ||
      text.starts_with('p')) {  // a scale factor, which applies to writing only
    text.remove_prefix(1);
    text.remove_prefix(text.starts_with(',') ? 1 : 0);
    format.per_line = take_number(text);
  }
  if (text.empty() || std::string_view("IFEGifeg").find(text.front()) == std::string_view::npos)
    return std::nullopt;
  text.remove_prefix(1);
  format.width = take_number(text);
  if (format.per_line == 0 || format.width == 0) return std::nullopt;
  return format;
}

std::optional<std::vector<double>> read_fortran_numbers(LineReader& lines,
                                                        const FortranFormat& format,
                                                        std::size_t count, std::string_view what,
                                                        FileProblems& problems) {
  if (count > RecordBuilder::kMaxValues)
    return problems.add(lines.number(),
                        fmt::format("{}: at most {} numbers", what, RecordBuilder::kMaxValues));
  std::vector<double> numbers;
  for (std::string_view line; numbers.size() < count && lines.next(line);) {
    const std::size_t on_line = std::min(format.per_line, count - numbers.size());
    for (std::size_t i = 0; i < on_line; ++i) {
      const std::size_t begin = std::min(i * format.width, line.size());
      const std::string_view field = trimmed(line.substr(begin, format.width));
      if (!lines.line_ended() && !field.empty() && line.size() < begin + format.width)
        return problems.add(lines.number(),
                            fmt::format("{}: the file is cut off inside number {}, {}", what,
                                        numbers.size() + 1, show_text(field)));
      const auto number = parse_number(field);
      if (!number || !std::isfinite(*number))
        return problems.add(
            lines.number(),
            field.empty() ? fmt::format("{}: only {} of {} numbers", what, numbers.size(), count)
                          : fmt::format("{}: {} is not a finite number", what, show_text(field)));
      numbers.push_back(*number);
    }
  }
  if (numbers.size() == count) return numbers;
  if (!problems.any())
    problems.add(lines.number(), fmt::format("{}: the file ends after {} of {} numbers", what,
                                             numbers.size(), count));
  return std::nullopt;
}

}  // namespace framewatch::drivers
