// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <fmt/core.h>

namespace framewatch::daemon {

/// Returns the text with a capital first letter, if that is a to z.
std::string with_capital(std::string text);

/// Returns "a, b, c", or "a, b and 3 more" when there are more than `most` names. `rest`: fmt
/// format of the number of the others.
std::string listed(const std::vector<std::string>& names, std::size_t most = SIZE_MAX,
                   const char* rest = " and {} more");

/// Returns "[a, b, c]": `text` of each item.
template <typename Items, typename Text>
std::string bracketed(const Items& items, const Text& text, const char* between = ", ") {
  std::string out;
  for (const auto& item : items) out += (out.empty() ? "" : between) + text(item);
  return "[" + out + "]";
}

/// Returns the same list of `count` texts: text(0), text(1), ...
template <typename Text>
std::string bracketed(int count, const Text& text) {
  std::string out;
  for (int i = 0; i < count; ++i) out += (i == 0 ? "" : ", ") + text(i);
  return "[" + out + "]";
}

/// Returns the value in a fmt format, or "-" if it is not finite.
inline std::string or_dash(double value, const char* format) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

/// Returns the text escaped in <p>, or "" for an empty text.
std::string html_paragraph(const std::string& text);

}  // namespace framewatch::daemon
