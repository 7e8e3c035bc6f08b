// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fleet/message/message.h"
#include "fleet/store/database.h"

namespace framewatch::fleet {

using Rows = std::vector<Database::Row>;

/// Return the value of a column; 0, an empty text or nullopt for NULL and malformed numbers.
std::string text_at(const Database::Row& row, std::size_t column);
std::int64_t integer_at(const Database::Row& row, std::size_t column);
std::optional<double> number_at(const Database::Row& row, std::size_t column);
/// Returns the bytes of a bytea in text form.
Bytes bytes_at(const Database::Row& row, std::size_t column);

/// Returns SQL that converts the timestamptz expression `time` to microseconds since 1970.
std::string sql_us(const std::string& time);

}  // namespace framewatch::fleet
