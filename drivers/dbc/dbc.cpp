// SPDX-License-Identifier: MIT
#include "drivers/dbc/dbc.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "drivers/files/number_text.h"

namespace framewatch::drivers {
namespace {

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Walks through the text of a DBC file word by word. A function that does not find what it looks
/// for consumes nothing.
class DbcScanner {
 public:
  explicit DbcScanner(std::string_view text) : text_(text) {}

  bool at_end() const { return at_ >= text_.size(); }
  std::int64_t line() const { return line_; }
  /// Returns the rest of this line, for messages.
  std::string_view rest_of_line() const {
    const std::size_t end = text_.find_first_of("\r\n", at_);
    return text_.substr(at_, end == std::string_view::npos ? end : end - at_);
  }

  /// Skips blanks and line ends.
  void skip_space() {
    while (!at_end() && (here() == ' ' || here() == '\t' || here() == '\r' || here() == '\n'))
      step();
  }

  /// Skips blanks within the line.
  void skip_blanks() {
    while (!at_end() && (here() == ' ' || here() == '\t' || here() == '\r')) step();
  }

  void skip_line() {
    while (!at_end() && here() != '\n') step();
    if (!at_end()) step();
  }

  /// Skips to after the next ';' outside quotes. Returns false at the end of the file.
  bool skip_statement() {
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

  /// Reads a name of letters, digits and _ that does not begin with a digit. Returns an empty text
  /// when there is no name.
  std::string_view word() {
    const std::string_view found = peek_word();
    at_ += found.size();
    return found;
  }

  /// Returns what word() would return, without consuming it.
  std::string_view peek_word() {
    skip_blanks();
    if (!is_letter(here())) return {};
    std::size_t end = at_;
    while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
    return text_.substr(at_, end - at_);
  }

  /// Reads a character after blanks. Returns false for another one.
  bool symbol(char wanted) {
    skip_blanks();
    if (here() != wanted) return false;
    step();
    return true;
  }

  std::optional<std::uint64_t> natural() {
    skip_blanks();
    std::uint64_t value = 0;
    const auto [end, error] =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc{}) return std::nullopt;
    at_ = static_cast<std::size_t>(end - text_.data());
    return value;
  }

  std::optional<double> number() {
    skip_blanks();
    std::size_t end = at_;
    while (end < text_.size() &&
           (is_digit(text_[end]) ||
            std::string_view("+-.eE").find(text_[end]) != std::string_view::npos))
      ++end;
    const std::optional<double> value = parse_number(text_.substr(at_, end - at_));
    if (value) at_ = end;
    return value;
  }

  /// Reads a text in quotes, which may span lines. Returns nullopt when the next character is not a
  /// quote, or the text does not end.
  std::optional<std::string> quoted() {
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

 private:
  char here() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void step() {
    if (here() == '\n') ++line_;
    ++at_;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::int64_t line_ = 1;
};

constexpr std::uint32_t kExtendedFlag = 0x80000000u;
constexpr std::uint64_t kIndependent = 0xC0000000u;  ///< VECTOR__INDEPENDENT_SIG_MSG

/// Statements that end with a semicolon and are not needed.
constexpr std::array kSkipped = {
    "CM_",        "BA_DEF_",       "BA_DEF_DEF_",  "BA_DEF_REL_",    "BA_DEF_DEF_REL_",
    "BA_REL_",    "BA_SGTYPE_",    "VAL_",         "VAL_TABLE_",     "BO_TX_BU_",
    "EV_",        "EV_DATA_",      "ENVVAR_DATA_", "SGTYPE_",        "SGTYPE_VAL_",
    "SIG_GROUP_", "SIG_TYPE_REF_", "SG_MUL_VAL_",  "BA_DEF_SGTYPE_", "CAT_DEF_",
    "CAT_",       "FILTER",        "BU_EV_REL_",   "BU_SG_REL_",     "BU_BO_REL_"};

/// Parses a DBC file statement by statement.
class Parser {
 public:
  Parser(const std::string& path, std::string_view text, std::vector<Problem>& problems)
      : scan_(text), problems_(path, problems) {}

  std::optional<Dbc> run() {
    for (scan_.skip_space(); !scan_.at_end() && !problems_.full(); scan_.skip_space()) statement();
    finish_message();
    check_messages();
    apply_value_types();
    for (const DbcMessage& message : dbc_.messages)
      for (const DbcRule& rule : broken_rules(message)) problems_.add(rule.line, rule.message);
    if (problems_.any()) return std::nullopt;
    return std::move(dbc_);
  }

 private:
  struct FloatType {
    std::int64_t line;
    std::uint64_t id;
    std::string signal;
    std::uint64_t type;
  };

  void fail(const std::string& rule) {
    problems_.add(scan_.line(), fmt::format("{}, here: {}", rule, show_text(scan_.rest_of_line())));
    scan_.skip_line();
  }

  void statement() {
    const std::string keyword(scan_.peek_word());
    if (keyword != "SG_") finish_message();
    if (std::find(kSkipped.begin(), kSkipped.end(), keyword) != kSkipped.end()) {
      const std::int64_t line = scan_.line();
      if (!scan_.skip_statement())
        problems_.add(line, keyword + " does not end: a ; or a closing quote is missing");
      return;
    }
    if (keyword.empty()) return fail("expected a statement");
    (void)scan_.word();
    if (keyword == "VERSION") {
      if (!scan_.quoted()) fail("VERSION is followed by a text in quotes");
    } else if (keyword == "NS_") {
      new_symbols();
    } else if (keyword == "BS_" || keyword == "BU_") {
      if (!scan_.symbol(':')) return fail(keyword + " is followed by a colon");
      scan_.skip_line();
    } else if (keyword == "BO_") {
      message();
    } else if (keyword == "SG_") {
      signal();
    } else if (keyword == "BA_") {
      attribute();
    } else if (keyword == "SIG_VALTYPE_") {
      value_type();
    } else {
      fail("unknown statement " + keyword);
    }
  }

  /// Skips the list of keywords: one on each line, up to the first line with more than one word.
  void new_symbols() {
    if (!scan_.symbol(':')) return fail("NS_ is followed by a colon");
    scan_.skip_line();
    while (!scan_.at_end()) {
      scan_.skip_space();
      const std::string_view line = trimmed(scan_.rest_of_line());
      const std::string_view word = scan_.peek_word();
      if (word.empty() || line != word) return;
      scan_.skip_line();
    }
  }

  void finish_message() {
    if (open_) dbc_.messages.push_back(std::move(*open_));
    open_.reset();
    dropped_ = false;
  }

  void message() {
    finish_message();
    DbcMessage m;
    m.line = scan_.line();
    const auto id = scan_.natural();
    dropped_ = true;  // skip the signals of a message that cannot be read
    if (!id) return fail("BO_ is followed by an id");
    m.name = scan_.word();
    if (m.name.empty() || !scan_.symbol(':'))
      return fail("BO_ id is followed by a name and a colon");
    const auto length = scan_.natural();
    if (!length || scan_.word().empty()) return fail("expected a length in bytes and a sender");
    scan_.skip_line();
    if (*id == kIndependent) return;
    m.extended = (*id & kExtendedFlag) != 0;
    m.id = static_cast<std::uint32_t>(*id) & ~kExtendedFlag;
    if (*id > 0xFFFFFFFFu || m.id > (m.extended ? 0x1FFFFFFFu : 0x7FFu)) {
      problems_.add(m.line, fmt::format("id {} of {} is not a valid {}-bit id{}", *id, m.name,
                                        m.extended ? 29 : 11,
                                        m.extended ? "" : "; a 29-bit one has bit 31 set"));
      return;
    }
    m.length = *length > 64 ? 65 : static_cast<int>(*length);
    open_ = std::move(m);
    dropped_ = false;
  }

  void signal() {
    if (!open_) {
      if (!dropped_) return fail("SG_ without a BO_ before it");
      return scan_.skip_line();
    }
    DbcSignal s;
    s.line = scan_.line();
    s.name = scan_.word();
    if (s.name.empty()) return fail("SG_ is followed by a name");
    if (!multiplexing(std::string(scan_.word()), s))
      return fail(fmt::format("signal {}: expected M, m<number> or a colon", s.name));
    if (!scan_.symbol(':')) return fail(fmt::format("signal {}: expected a colon", s.name));
    if (!layout(s.field) || !scaling(s))
      return fail(fmt::format(
          "signal {}: expected start|bits@0 or 1 and + or -, (factor,offset), [min|max], \"unit\"",
          s.name));
    scan_.skip_line();
    open_->signals.push_back(std::move(s));
  }

  static bool multiplexing(std::string_view word, DbcSignal& s) {
    if (word.empty()) return true;
    if (word == "M") return s.is_multiplexor = true;
    if (word.ends_with('M')) {  // multiplexed, and a multiplexor of others
      s.is_multiplexor = true;
      word.remove_suffix(1);
    }
    if (!word.starts_with('m')) return false;
    const auto value = parse_integer(word.substr(1));
    if (!value || *value < 0) return false;
    s.multiplexed_by = *value;
    return true;
  }

  bool layout(CanField& field) {
    const auto start = scan_.natural();
    if (!start || !scan_.symbol('|')) return false;
    const auto bits = scan_.natural();
    if (!bits || !scan_.symbol('@')) return false;
    const auto order = scan_.natural();
    if (!order || *order > 1) return false;
    field.start = *start > 511 ? 512 : static_cast<int>(*start);
    field.bits = *bits > 64 ? 65 : static_cast<int>(*bits);
    field.little_endian = *order == 1;
    field.is_signed = scan_.symbol('-');
    return field.is_signed || scan_.symbol('+');
  }

  bool scaling(DbcSignal& s) {
    if (!scan_.symbol('(')) return false;
    const auto factor = scan_.number();
    if (!factor || !scan_.symbol(',')) return false;
    const auto offset = scan_.number();
    if (!offset || !scan_.symbol(')') || !scan_.symbol('[')) return false;
    if (!scan_.number() || !scan_.symbol('|') || !scan_.number() || !scan_.symbol(']'))
      return false;
    const auto unit = scan_.quoted();
    if (!unit) return false;
    s.field.factor = *factor;
    s.field.offset = *offset;
    s.unit = *unit;
    return true;
  }

  /// Reads BA_ "GenMsgCycleTime" BO_ id value and skips other attributes.
  void attribute() {
    const std::int64_t line = scan_.line();
    const auto name = scan_.quoted();
    if (name && *name == "GenMsgCycleTime" && scan_.peek_word() == "BO_") {
      (void)scan_.word();
      const auto id = scan_.natural();
      const auto cycle_ms = scan_.number();
      if (id && cycle_ms && *cycle_ms >= 0) cycles_[*id] = *cycle_ms / 1000;
    }
    if (!scan_.skip_statement()) problems_.add(line, "BA_ does not end: a ; is missing");
  }

  void value_type() {
    FloatType type{scan_.line(), 0, {}, 0};
    const auto id = scan_.natural();
    type.signal = scan_.word();
    (void)scan_.symbol(':');
    const auto value = scan_.natural();
    if (!id || type.signal.empty() || !value || *value > 2 || !scan_.symbol(';'))
      return fail("SIG_VALTYPE_ is followed by id, signal, :, 0, 1 or 2 and ;");
    type.id = *id;
    type.type = *value;
    floats_.push_back(type);
  }

  void apply_value_types() {
    std::map<std::pair<std::uint64_t, std::string>, DbcSignal*> signals;
    for (DbcMessage& m : dbc_.messages)
      for (DbcSignal& s : m.signals)
        signals.emplace(std::pair(m.id | (m.extended ? kExtendedFlag : 0), s.name), &s);
    for (const FloatType& type : floats_) {
      const auto at = signals.find({type.id, type.signal});
      if (at == signals.end())
        problems_.add(type.line, fmt::format("SIG_VALTYPE_: message {} has no signal {}", type.id,
                                             type.signal));
      else
        at->second->field.value = type.type == 1   ? CanValue::float32
                                  : type.type == 2 ? CanValue::float64
                                                   : CanValue::integer;
    }
  }

  void check_messages() {
    std::map<std::uint64_t, const DbcMessage*> ids;
    std::map<std::string, const DbcMessage*> names;
    for (DbcMessage& m : dbc_.messages) {
      const std::uint64_t id = m.id | (m.extended ? kExtendedFlag : 0);
      const auto [same_id, new_id] = ids.emplace(id, &m);
      if (!new_id)
        problems_.add(m.line, fmt::format("{} has the id of {} (line {})", m.name,
                                          same_id->second->name, same_id->second->line));
      const auto [same_name, new_name] = names.emplace(m.name, &m);
      if (!new_name)
        problems_.add(m.line, fmt::format("{} is the name of another message (line {})", m.name,
                                          same_name->second->line));
      if (const auto cycle = cycles_.find(id); cycle != cycles_.end()) m.cycle_s = cycle->second;
    }
  }

  DbcScanner scan_;
  FileProblems problems_;
  Dbc dbc_;
  std::optional<DbcMessage> open_;
  bool dropped_ = false;
  std::vector<FloatType> floats_;
  std::map<std::uint64_t, double> cycles_;
};

}  // namespace

const DbcSignal* DbcMessage::find(const std::string& signal) const {
  for (const DbcSignal& s : signals)
    if (s.name == signal) return &s;
  return nullptr;
}

const DbcSignal* DbcMessage::multiplexor() const {
  for (const DbcSignal& s : signals)
    if (s.is_multiplexor && !s.multiplexed_by) return &s;
  return nullptr;
}

const DbcMessage* Dbc::find(const std::string& message) const {
  for (const DbcMessage& m : messages)
    if (m.name == message) return &m;
  return nullptr;
}

std::optional<Dbc> parse_dbc(const std::string& path, const std::string& text,
                             std::vector<Problem>& problems) {
  std::string_view content = text;
  if (content.starts_with("\xEF\xBB\xBF")) content.remove_prefix(3);
  if (content.find('\0') != std::string_view::npos) {
    problems.push_back({path, "is not a text file: it has bytes of value 0"});
    return std::nullopt;
  }
  return Parser(path, content, problems).run();
}

}  // namespace framewatch::drivers
