// SPDX-License-Identifier: MIT
#include "drivers/dbc/dbc_scanner.h"

#include <charconv>
#include <system_error>

#include "drivers/files/number_text.h"

namespace framewatch::drivers {
namespace {

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

}  // namespace

std::string_view DbcScanner::rest_of_line() const {
  const std::size_t end = text_.find_first_of("\r\n", at_);
  return text_.substr(at_, end == std::string_view::npos ? end : end - at_);
}

void DbcScanner::skip_space() {
  while (!at_end()) {
    if (here() == ' ' || here() == '\t' || here() == '\r' || here() == '\n')
      step();
    else if (text_.substr(at_).starts_with("//"))
      skip_line();
    else
      return;
  }
}

void DbcScanner::skip_line() {
  while (!at_end() && here() != '\n') step();
  if (!at_end()) step();
}

bool DbcScanner::skip_statement() {
  for (skip_space(); !at_end(); skip_space()) {
    if (here() == '"') {
      if (!quoted()) return false;
      continue;
    }
    const bool last = here() == ';';
    step();
    if (last) return true;
  }
  return false;
}

std::string_view DbcScanner::word() {
  const std::string_view found = peek_word();
  at_ += found.size();
  return found;
}

std::string_view DbcScanner::peek_word() {
  skip_space();
  if (!is_letter(here())) return {};
  std::size_t end = at_;
  while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
  return text_.substr(at_, end - at_);
}

bool DbcScanner::symbol(char wanted) {
  skip_space();
  if (here() != wanted) return false;
  step();
  return true;
}

std::optional<std::uint64_t> DbcScanner::natural() {
  skip_space();
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
  if (error != std::errc{}) return std::nullopt;
  at_ = static_cast<std::size_t>(end - text_.data());
  return value;
}

std::optional<double> DbcScanner::number() {
  skip_space();
  std::size_t end = at_;
  while (end < text_.size() && (is_digit(text_[end]) || std::string_view("+-.eE").find(
                                                            text_[end]) != std::string_view::npos))
    ++end;
  const std::optional<double> value = parse_number(text_.substr(at_, end - at_));
  if (value) at_ = end;
  return value;
}

std::optional<std::string> DbcScanner::quoted() {
  skip_space();
  if (here() != '"') return std::nullopt;
  std::string out;
  for (step(); !at_end(); step()) {
    if (here() == '\\' && at_ + 1 < text_.size() && text_[at_ + 1] == '"') {
      step();
      out += '"';
    } else if (here() == '"') {
      step();
      return out;
    } else {
      out += here();
    }
  }
  return std::nullopt;
}

}  // namespace framewatch::drivers
