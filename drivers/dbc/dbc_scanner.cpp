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

void DbcScanner::step() {
  if (here() == '\n') ++line_;
  ++at_;
}

std::string_view DbcScanner::rest_of_line() const {
  const std::size_t end = text_.find_first_of("\r\n", at_);
  return text_.substr(at_, end == std::string_view::npos ? end : end - at_);
}

void DbcScanner::skip_space() {
  while (!at_end() && (here() == ' ' || here() == '\t' || here() == '\r' || here() == '\n')) step();
}

void DbcScanner::skip_blanks() {
  while (!at_end() && (here() == ' ' || here() == '\t' || here() == '\r')) step();
}

void DbcScanner::skip_line() {
  while (!at_end() && here() != '\n') step();
  if (!at_end()) step();
}

bool DbcScanner::skip_statement() {
  while (!at_end()) {
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

std::string_view DbcScanner::peek_word() {
  skip_blanks();
  if (!is_letter(here())) return {};
  std::size_t end = at_;
  while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
  return text_.substr(at_, end - at_);
}

std::string_view DbcScanner::word() {
  const std::string_view found = peek_word();
  at_ += found.size();
  return found;
}

bool DbcScanner::symbol(char wanted) {
  skip_blanks();
  if (here() != wanted) return false;
  step();
  return true;
}

std::optional<std::uint64_t> DbcScanner::natural() {
  skip_blanks();
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
  if (error != std::errc{}) return std::nullopt;
  at_ = static_cast<std::size_t>(end - text_.data());
  return value;
}

std::optional<double> DbcScanner::number() {
  skip_blanks();
  std::size_t end = at_;
  while (end < text_.size() && (is_digit(text_[end]) || std::string_view("+-.eE").find(
                                                            text_[end]) != std::string_view::npos))
    ++end;
  const std::optional<double> value = parse_number(text_.substr(at_, end - at_));
  if (value) at_ = end;
  return value;
}

std::optional<std::string> DbcScanner::quoted() {
  skip_blanks();
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
