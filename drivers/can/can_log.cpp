// SPDX-License-Identifier: MIT
#include "drivers/can/can_log.h"

#include <algorithm>
#include <optional>

#include <fmt/core.h>

#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kHeadLines = 10;
constexpr std::uint32_t kErrorFlag = 0x20000000u;

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::optional<std::int64_t> digits(std::string_view text) {
  const bool unsigned_digits = text.find_first_not_of("0123456789") == std::string_view::npos;
  return unsigned_digits ? parse_integer(text) : std::nullopt;
}

/// Removes "(seconds.microseconds) " or "(seconds.nanoseconds) " from the beginning of the line.
bool take_stamp(std::string_view& line, std::int64_t& stamp_us) {
  constexpr std::int64_t kMaxSeconds = std::int64_t{1} << 33;
  const std::size_t dot = line.find('.'), close = line.find(')');
  if (line.empty() || line.front() != '(' || dot == std::string_view::npos ||
      close == std::string_view::npos || (close != dot + 7 && close != dot + 10))
    return false;
  const auto seconds = digits(line.substr(1, dot - 1));
  const auto decimals = digits(line.substr(dot + 1, close - dot - 1));
  if (!seconds || !decimals || *seconds > kMaxSeconds) return false;
  stamp_us = 1'000'000 * *seconds + (close == dot + 7 ? *decimals : *decimals / 1000);
  line.remove_prefix(close + 1);
  while (line.starts_with(' ')) line.remove_prefix(1);
  return true;
}

bool take_word(std::string_view& line, std::string_view& word) {
  const std::size_t end = std::min(line.find(' '), line.size());
  word = line.substr(0, end);
  line.remove_prefix(end);
  while (line.starts_with(' ')) line.remove_prefix(1);
  return !word.empty();
}

bool read_id(std::string_view text, CanFrame& frame) {
  if (text.size() != 3 && text.size() != 8) return false;
  std::uint32_t id = 0;
  for (const char c : text) {
    const int digit = hex_digit(c);
    if (digit < 0) return false;
    id = id << 4 | static_cast<std::uint32_t>(digit);
  }
  frame.extended = text.size() == 8;
  frame.error = frame.extended && (id & kErrorFlag) != 0 && id <= 0x3FFFFFFFu;
  if (frame.error) {
    frame.extended = false;
    id &= 0x1FFFFFFFu;
  }
  frame.id = id;
  return id <= (frame.extended || frame.error ? 0x1FFFFFFFu : 0x7FFu);
}

bool read_data(std::string_view text, CanFrame& frame) {
  const std::size_t bytes = text.size() / 2;
  if (text.size() % 2 != 0 || bytes > (frame.fd ? 64u : 8u) ||
      !is_fd_length(static_cast<int>(bytes)))
    return false;
  for (std::size_t i = 0; i < bytes; ++i) {
    const int high = hex_digit(text[2 * i]), low = hex_digit(text[2 * i + 1]);
    if (high < 0 || low < 0) return false;
    frame.data[i] = static_cast<std::uint8_t>(16 * high + low);
  }
  frame.length = static_cast<std::uint8_t>(bytes);
  return true;
}

bool is_remark(std::string_view line) {
  return line.empty() || line.front() == '#';
}

}  // namespace

bool parse_candump_line(std::string_view line, CanFrame& frame, std::string_view& interface,
                        std::string& rule) {
  frame = {};
  std::string_view text;
  const auto fail = [&](const char* why) {
    rule = why;
    return false;
  };
  if (!take_stamp(line, frame.stamp_us))
    return fail("does not begin with (seconds.decimals), with 6 or 9 decimals");
  if (!take_word(line, interface) || interface.size() > 15) return fail("names no interface");
  if (!take_word(line, text)) return fail("has no frame after the interface");
  const std::size_t hash = text.find('#');
  if (hash == std::string_view::npos || !read_id(text.substr(0, hash), frame))
    return fail("has no id of 3 or 8 hexadecimal digits before #");
  text.remove_prefix(hash + 1);
  if (text.starts_with('#')) {
    const int flags = text.size() > 1 ? hex_digit(text[1]) : -1;
    if (flags < 0 || frame.error) return fail("has no CAN FD flags after ##");
    frame.fd = true;
    frame.bit_rate_switch = (flags & 1) != 0;
    text.remove_prefix(2);
  } else if (text.starts_with('R')) {
    const int length = text.size() > 1 ? hex_digit(text[1]) : 0;
    if (text.size() > 2 || length < 0 || length > 8) return fail("has no valid length after #R");
    frame.remote = true;
    frame.length = static_cast<std::uint8_t>(length);
    text = {};
    return line.size() <= 1 || fail("continues after the frame");
  }
  // A raw length code above 8 may follow as _D.
  if (!frame.fd && text.size() == 18 && text[16] == '_') text.remove_suffix(2);
  if (!read_data(text, frame))
    return fail("does not have 0 to 8 bytes (CAN FD: 0 to 64) in hexadecimal");
  return line.size() <= 1 || fail("continues after the frame");
}

std::string candump_line(const CanFrame& frame, std::string_view interface) {
  std::string out = fmt::format("({:010}.{:06}) {} ", frame.stamp_us / 1'000'000,
                                frame.stamp_us % 1'000'000, interface);
  if (frame.error)
    out += fmt::format("{:08X}#", frame.id | kErrorFlag);
  else
    out += frame.extended ? fmt::format("{:08X}#", frame.id) : fmt::format("{:03X}#", frame.id);
  if (frame.remote) return out + (frame.length > 0 ? fmt::format("R{:X}", frame.length) : "R");
  if (frame.fd) out += fmt::format("#{:X}", frame.bit_rate_switch ? 1 : 0);
  for (std::size_t i = 0; i < frame.length; ++i) out += fmt::format("{:02X}", frame.data[i]);
  return out;
}

bool looks_like_candump(const std::string& path) {
  std::vector<Problem> ignored;
  FileProblems problems(path, ignored);
  LineReader lines(problems);
  std::string_view line, interface;
  std::string rule;
  CanFrame frame;
  while (lines.number() < kHeadLines && lines.next(line))
    if (parse_candump_line(line, frame, interface, rule)) return true;
  return false;
}

bool read_candump(const std::string& path, const TakeCanFrame& take, std::vector<Problem>& found) {
  FileProblems problems(path, found);
  LineReader lines(problems);
  std::string_view line, interface;
  std::string rule;
  CanFrame frame;
  while (lines.next(line)) {
    if (is_remark(line)) continue;
    if (parse_candump_line(line, frame, interface, rule))
      take(frame, interface);
    else
      problems.add(lines.number(), "the line " + rule + ": " + show_text(line));
  }
  return !problems.any();
}

bool CanLogWriter::write(const CanFrame& frame, std::string_view interface) {
  return out_.write(candump_line(frame, interface) + "\n");
}

}  // namespace framewatch::drivers
