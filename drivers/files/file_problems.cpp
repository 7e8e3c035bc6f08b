// SPDX-License-Identifier: MIT
#include "drivers/files/file_problems.h"

#include <fmt/core.h>

namespace framewatch::drivers {

std::nullopt_t FileProblems::add(std::int64_t line, const std::string& message) {
  if (full()) return std::nullopt;
  problems_->push_back({line > 0 ? fmt::format("{}:{}", path_, line) : path_, message});
  ++count_;
  if (full()) problems_->push_back({path_, fmt::format("only the first {} are listed", kMax)});
  return std::nullopt;
}

std::string show_text(std::string_view text) {
  constexpr std::size_t kShown = 40;
  std::string shown = "\"";
  for (const char c : text.substr(0, kShown)) shown += (c >= 0x20 && c < 0x7f) ? c : '?';
  return shown + (text.size() > kShown ? "...\"" : "\"");
}

}  // namespace framewatch::drivers
