// SPDX-License-Identifier: MIT
#include "daemon/base/words.h"

#include <algorithm>

#include <fmt/ranges.h>

#include "daemon/base/printable.h"

namespace framewatch::daemon {

std::string with_capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z')
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string listed(const std::vector<std::string>& names, std::size_t most, const char* rest) {
  const auto shown = names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), most));
  std::string out = fmt::format("{}", fmt::join(names.begin(), shown, ", "));
  if (names.size() > most) out += fmt::format(fmt::runtime(rest), names.size() - most);
  return out;
}

std::string html_paragraph(const std::string& text) {
  return text.empty() ? "" : "<p>" + html_text(text) + "</p>\n";
}

}  // namespace framewatch::daemon
