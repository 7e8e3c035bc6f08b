// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace framewatch::drivers {

/// Writes or reads the state (estimator/state/archive.h) of a vector of variable length.
template <typename Archive, typename T>
void archive_vector(Archive& a, std::vector<T>& values) {
  const std::size_t size = a.count(values.size());
  if constexpr (Archive::kReading) values.resize(size);
  for (T& value : values) a(value);
}

/// Writes or reads the state of an optional.
template <typename Archive, typename T>
void archive_optional(Archive& a, std::optional<T>& value) {
  bool has_value = value.has_value();
  a(has_value);
  if constexpr (Archive::kReading) value = has_value ? std::optional<T>(T{}) : std::nullopt;
  if (value) a(*value);
}

}  // namespace framewatch::drivers
