#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace framewatch::drivers {

/// State of a vector of classes whose number is no matter of the configuration
/// (estimator/state/archive.h).
template <typename Archive, typename T>
void archive_list(Archive& a, std::vector<T>& values) {
  const std::size_t size = a.count(values.size());
  if constexpr (Archive::kReading) values.resize(size);
  for (T& value : values) a(value);
}

/// State of what may be there or not.
template <typename Archive, typename T>
void archive_optional(Archive& a, std::optional<T>& value) {
  bool there = value.has_value();
  a(there);
  if constexpr (Archive::kReading) value = there ? std::optional<T>(T{}) : std::nullopt;
  if (value) a(*value);
}

}  // namespace framewatch::drivers
