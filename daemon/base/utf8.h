#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace framewatch::daemon {

/// A character of a text.
struct CodePoint {
  std::uint32_t value = 0;
  std::size_t bytes = 0;  ///< 0: what is there is no UTF-8
};

/// The first one of a text that is not empty.
CodePoint first_character(std::string_view text);

}  // namespace framewatch::daemon
