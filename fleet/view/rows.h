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

/// Columns of an answer; NULL or no number: 0, or empty.
std::string text_at(const Database::Row& row, std::size_t column);
std::int64_t integer_at(const Database::Row& row, std::size_t column);
std::optional<double> number_at(const Database::Row& row, std::size_t column);
/// Of a bytea.
Bytes bytes_at(const Database::Row& row, std::size_t column);

/// An expression of a timestamptz as microseconds since 1970, or of the time now.
std::string sql_us(const std::string& time);

}  // namespace framewatch::fleet
