#include "daemon/base/printable.h"

#include <cstdint>

#include <fmt/core.h>

#include "daemon/base/utf8.h"

namespace framewatch::daemon {
namespace {

/// Whether it acts on what shows it, instead of being shown.
bool controls(std::uint32_t c) {
  return c < 0x20 || (c >= 0x7f && c < 0xa0) || c == 0x61c || c == 0x200e || c == 0x200f ||
         (c >= 0x2028 && c <= 0x202e) || (c >= 0x2066 && c <= 0x2069) || c == 0xfeff;
}

std::string escape_of(std::uint32_t c) {
  if (c == '\n') return "\\n";
  if (c == '\r') return "\\r";
  if (c == '\t') return "\\t";
  return c < 0x80 ? fmt::format("\\x{:02x}", c) : fmt::format("\\u{:04x}", c);
}

}  // namespace

std::string printable(std::string_view text, std::size_t most) {
  constexpr std::string_view kCut = "...";
  std::string out;
  std::size_t uncut = 0;  // bytes that leave room for the mark of a cut
  while (!text.empty()) {
    const CodePoint c = first_character(text);
    std::string piece;
    if (c.bytes == 0)
      piece = fmt::format("\\x{:02x}", static_cast<std::uint8_t>(text[0]));
    else if (controls(c.value))
      piece = escape_of(c.value);
    else
      piece = text.substr(0, c.bytes);
    text.remove_prefix(c.bytes == 0 ? 1 : c.bytes);
    if (out.size() + piece.size() > most) return out.substr(0, uncut).append(kCut);
    out += piece;
    if (out.size() + kCut.size() <= most) uncut = out.size();
  }
  return out;
}

std::string printable_lines(std::string_view text) {
  std::string out;
  for (;;) {
    const std::size_t end = text.find('\n');
    out += printable(text.substr(0, end), std::string::npos);
    if (end == std::string_view::npos) return out;
    out += '\n';
    text.remove_prefix(end + 1);
  }
}

}  // namespace framewatch::daemon
