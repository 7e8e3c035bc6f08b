// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace framewatch::drivers {

/// Parses all of `text` as a decimal number, in any locale; "nan" and "inf" count as numbers, and
/// so does a double of Fortran, "1.5D-02". Returns nullopt for any other text.
std::optional<double> parse_number(std::string_view text);
/// Parses all of `text` as a whole number. Returns nullopt for any other text.
std::optional<std::int64_t> parse_integer(std::string_view text);
/// Parses a sample: a number, or NaN for "nan" and an empty field. Returns nullopt for infinities
/// and any other text.
std::optional<double> parse_sample(std::string_view text);
/// Returns the shortest text that parses back to the same double.
std::string format_number(double value);

/// Returns `text` without blanks and tabs at its ends.
std::string_view trimmed(std::string_view text);
/// Splits a line at commas into trimmed `fields`; a line without commas is one field.
void split_commas(std::string_view line, std::vector<std::string_view>& fields);
/// Splits a line at runs of blanks, tabs, commas and semicolons into `fields`.
void split_blanks(std::string_view line, std::vector<std::string_view>& fields);

}  // namespace framewatch::drivers
