// SPDX-License-Identifier: MIT
#include "fleet/view/rows.h"

#include <fmt/core.h>

#include "drivers/files/number_text.h"

namespace framewatch::fleet {
namespace {

int digit_of(char c) {
  return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : 0;
}

}  // namespace

std::string text_at(const Database::Row& row, std::size_t column) {
  return row[column].value_or("");
}

std::int64_t integer_at(const Database::Row& row, std::size_t column) {
  return drivers::parse_integer(text_at(row, column)).value_or(0);
}

std::optional<double> number_at(const Database::Row& row, std::size_t column) {
  return row[column] ? drivers::parse_number(*row[column]) : std::nullopt;
}

Bytes bytes_at(const Database::Row& row, std::size_t column) {
  const std::string text = text_at(row, column);
  Bytes out;
  out.reserve(text.size() / 2);
  for (std::size_t i = 2; i + 1 < text.size(); i += 2)
    out.push_back(static_cast<std::uint8_t>(16 * digit_of(text[i]) + digit_of(text[i + 1])));
  return out;
}

std::string sql_us(const std::string& time) {
  return fmt::format("(extract(epoch FROM {}) * 1000000)::bigint", time);
}

}  // namespace framewatch::fleet
