#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace framewatch::drivers {

/// A decimal number, the whole of `text`, whatever the locale; NaN and inf are read as such.
std::optional<double> parse_number(std::string_view text);
std::optional<std::int64_t> parse_integer(std::string_view text);
/// An acceleration: a number, or NaN for "nan" and an empty field; empty for inf and anything else.
std::optional<double> parse_sample(std::string_view text);
/// The shortest text that reads back as the same double.
std::string format_number(double value);

std::string_view trimmed(std::string_view text);
/// Fields between commas, trimmed.
void split_commas(std::string_view line, std::vector<std::string_view>& fields);
/// Fields between blanks, tabs, commas or semicolons, of which several count as one.
void split_blanks(std::string_view line, std::vector<std::string_view>& fields);

}  // namespace framewatch::drivers
