// SPDX-License-Identifier: MIT
#include "drivers/dbc/dbc.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "drivers/dbc/dbc_scanner.h"
#include "drivers/files/number_text.h"

namespace framewatch::drivers {
namespace {

constexpr std::uint32_t kExtendedFlag = 0x80000000u;
constexpr std::string_view kIndependent = "VECTOR__INDEPENDENT_SIG_MSG";

constexpr std::array kRead = {"VERSION", "NS_", "BS_",          "BU_",        "BO_",
                              "SG_",     "BA_", "SIG_VALTYPE_", "SG_MUL_VAL_"};
/// Statements that end with a semicolon and are not needed.
constexpr std::array kSkipped = {"CM_",
                                 "BA_DEF_",
                                 "BA_DEF_DEF_",
                                 "BA_DEF_REL_",
                                 "BA_DEF_DEF_REL_",
                                 "BA_REL_",
                                 "BA_SGTYPE_",
                                 "VAL_",
                                 "VAL_TABLE_",
                                 "BO_TX_BU_",
                                 "EV_",
                                 "EV_DATA_",
                                 "ENVVAR_DATA_",
                                 "SGTYPE_",
                                 "SGTYPE_VAL_",
                                 "SIG_GROUP_",
                                 "SIG_TYPE_REF_",
                                 "SIGTYPE_VALTYPE_",
                                 "BA_DEF_SGTYPE_",
                                 "CAT_DEF_",
                                 "CAT_",
                                 "FILTER",
                                 "BU_EV_REL_",
                                 "BU_SG_REL_",
                                 "BU_BO_REL_"};

template <std::size_t Count>
bool is_one_of(const std::array<const char*, Count>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Parses a DBC file statement by statement.
class Parser {
 public:
  Parser(const std::string& path, std::string_view text, std::vector<Problem>& problems)
      : scan_(text), problems_(path, problems) {}

  std::optional<Dbc> run() {
    for (scan_.skip_space(); !scan_.at_end() && !problems_.full(); scan_.skip_space()) statement();
    finish_message();
    index_messages();
    apply_value_types();
    apply_switches();
    find_only_multiplexors();
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
  struct Switched {
    std::int64_t line;
    std::uint64_t id;
    std::string signal, multiplexor;
    std::vector<ValueRange> values;
  };

  void fail(const std::string& rule) {
    problems_.add(line_, fmt::format("{}, here: {}", rule, show_text(scan_.rest_of_line())));
    if (!at_statement()) scan_.skip_line();
  }

  /// Returns true if a statement begins here. Nodes may have the name FILTER.
  bool at_statement() {
    const std::string_view word = scan_.peek_word();
    return word != "FILTER" && (is_one_of(kRead, word) || is_one_of(kSkipped, word));
  }

  /// Skips what is left of a line, except a statement.
  void end_line(std::int64_t line) {
    scan_.skip_space();
    if (scan_.line() == line && !at_statement()) scan_.skip_line();
  }

  void statement() {
    line_ = scan_.line();
    const std::string keyword(scan_.peek_word());
    if (keyword != "SG_") finish_message();
    if (is_one_of(kSkipped, keyword)) {
      if (!scan_.skip_statement())
        problems_.add(line_, keyword + " does not end: a ; or a closing quote is missing");
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
      const std::int64_t line = scan_.line();
      while (keyword == "BU_" && !at_statement() && !scan_.word().empty()) {
      }
      end_line(line);
    } else if (keyword == "BO_") {
      message();
    } else if (keyword == "SG_") {
      signal();
    } else if (keyword == "BA_") {
      attribute();
    } else if (keyword == "SIG_VALTYPE_") {
      value_type();
    } else if (keyword == "SG_MUL_VAL_") {
      switched();
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
    if (open_ && open_->name != kIndependent) dbc_.messages.push_back(std::move(*open_));
    open_.reset();
    dropped_ = false;
  }

  void message() {
    DbcMessage m;
    m.line = line_;
    const auto id = scan_.natural();
    dropped_ = true;  // skip the signals of a message that cannot be read
    if (!id) return fail("BO_ is followed by an id");
    m.name = scan_.word();
    if (m.name.empty() || !scan_.symbol(':'))
      return fail("BO_ id is followed by a name and a colon");
    const auto length = scan_.natural();
    if (!length || at_statement() || scan_.word().empty())
      return fail("expected a length in bytes and a sender");
    end_line(scan_.line());
    m.extended = (*id & kExtendedFlag) != 0;
    m.id = static_cast<std::uint32_t>(*id) & ~kExtendedFlag;
    if (*id > 0xFFFFFFFFu || m.id > (m.extended ? 0x1FFFFFFFu : 0x7FFu))
      m.contradictions.push_back(
          {m.line,
           fmt::format("id {} of {} is not a valid {}-bit id{}", *id, m.name, m.extended ? 29 : 11,
                       m.extended ? "" : "; a 29-bit one has bit 31 set")});
    m.length = *length > 64 ? 65 : static_cast<int>(*length);
    open_ = std::move(m);
    dropped_ = false;
  }

  void signal() {
    if (!open_) {
      if (!dropped_) return fail("SG_ without a BO_ before it");
      while (!scan_.at_end() && !at_statement()) scan_.skip_line();
      return;
    }
    DbcSignal s;
    s.line = line_;
    s.name = scan_.word();
    if (s.name.empty()) return fail("SG_ is followed by a name");
    if (!multiplexing(std::string(scan_.word()), s))
      return fail(fmt::format("signal {}: expected M, m<number> or a colon", s.name));
    if (!scan_.symbol(':')) return fail(fmt::format("signal {}: expected a colon", s.name));
    if (!layout(s.field) || !scaling(s))
      return fail(fmt::format(
          "signal {}: expected start|bits@0 or 1 and + or -, (factor,offset), [min|max], \"unit\"",
          s.name));
    skip_receivers();
    open_->signals.push_back(std::move(s));
  }

  /// Skips the names of nodes after a signal. They begin in the same line or the next, and go on in
  /// the next line after a comma.
  void skip_receivers() {
    const std::int64_t first_line = scan_.line();
    std::int64_t line = first_line;
    bool more = true;
    while (!at_statement() && (more || scan_.line() == line) && !scan_.word().empty()) {
      line = scan_.line();
      more = scan_.symbol(',');
    }
    end_line(first_line);
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
    s.present_at = {{static_cast<std::uint64_t>(*value), static_cast<std::uint64_t>(*value)}};
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
    const auto name = scan_.quoted();
    if (name && *name == "GenMsgCycleTime" && scan_.peek_word() == "BO_") {
      (void)scan_.word();
      const auto id = scan_.natural();
      const auto cycle_ms = scan_.number();
      if (id && cycle_ms && *cycle_ms >= 0) cycles_[*id] = *cycle_ms / 1000;
    }
    if (!scan_.skip_statement()) problems_.add(line_, "BA_ does not end: a ; is missing");
  }

  void value_type() {
    FloatType type{line_, 0, {}, 0};
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

  /// Reads SG_MUL_VAL_ id signal multiplexor least-most, least-most;
  void switched() {
    Switched s{line_, 0, {}, {}, {}};
    const auto id = scan_.natural();
    s.signal = scan_.word();
    s.multiplexor = scan_.word();
    bool good = id && !s.signal.empty() && !s.multiplexor.empty();
    do {
      const auto least = scan_.natural();
      const auto most = scan_.symbol('-') ? scan_.natural() : std::nullopt;
      const ValueRange range{least.value_or(UINT64_MAX), most.value_or(0)};
      good = good && least && most && range.least <= range.most;
      s.values.push_back(range);
    } while (good && scan_.symbol(','));
    if (!good || !scan_.symbol(';'))
      return fail(
          "SG_MUL_VAL_ is followed by id, signal, multiplexor, ranges such as 1-1, 4-7, "
          "and ;");
    s.id = *id;
    switched_.push_back(std::move(s));
  }

  /// Adds a contradiction to the messages, both to the second and to the first.
  static void same(const char* what, DbcMessage& first, DbcMessage& second) {
    second.contradictions.push_back(
        {second.line,
         fmt::format("{} has the {} of {} (line {})", second.name, what, first.name, first.line)});
    first.contradictions.push_back(
        {first.line,
         fmt::format("{} has the {} of {} (line {})", first.name, what, second.name, second.line)});
  }

  void index_messages() {
    std::map<std::string, DbcMessage*> names;
    for (DbcMessage& m : dbc_.messages) {
      const std::uint64_t id = m.id | (m.extended ? kExtendedFlag : 0);
      const auto [same_id, new_id] = messages_.emplace(id, &m);
      if (!new_id) same("id", *same_id->second, m);
      const auto [same_name, new_name] = names.emplace(m.name, &m);
      if (!new_name) same("name", *same_name->second, m);
      if (const auto cycle = cycles_.find(id); cycle != cycles_.end()) m.cycle_s = cycle->second;
      for (DbcSignal& s : m.signals) signals_.emplace(std::pair(id, std::string_view(s.name)), &s);
    }
  }

  /// Returns the signal that a statement names, or null. If the message exists without the signal,
  /// the message gets a contradiction.
  DbcSignal* named(const char* statement, std::int64_t line, std::uint64_t id,
                   const std::string& signal) {
    const auto at = signals_.find({id, signal});
    if (at != signals_.end()) return at->second;
    const auto message = messages_.find(id);
    if (message != messages_.end())
      message->second->contradictions.push_back(
          {line, fmt::format("{}: message {} has no signal {}", statement, id, signal)});
    return nullptr;
  }

  void apply_value_types() {
    for (const FloatType& type : floats_)
      if (DbcSignal* s = named("SIG_VALTYPE_", type.line, type.id, type.signal))
        s->field.value = type.type == 1   ? CanValue::float32
                         : type.type == 2 ? CanValue::float64
                                          : CanValue::integer;
  }

  /// Takes multiplexor and values from SG_MUL_VAL_. The number after m is one of the values.
  void apply_switches() {
    for (Switched& given : switched_) {
      DbcSignal* s = named("SG_MUL_VAL_", given.line, given.id, given.signal);
      if (s == nullptr) continue;
      const bool first = s->multiplexor.empty();
      const bool fits = !s->present_at.empty() &&
                        (first ? std::any_of(given.values.begin(), given.values.end(),
                                             [&](const ValueRange& range) {
                                               return s->present_at[0].least >= range.least &&
                                                      s->present_at[0].least <= range.most;
                                             })
                               : s->multiplexor == given.multiplexor);
      if (!fits)
        messages_.at(given.id)->contradictions.push_back(
            {given.line,
             fmt::format("SG_MUL_VAL_ contradicts signal {} (line {})", s->name, s->line)});
      if (first) s->present_at.clear();
      s->multiplexor = given.multiplexor;
      s->present_at.insert(s->present_at.end(), given.values.begin(), given.values.end());
    }
  }

  /// Gives multiplexed signals without SG_MUL_VAL_ the only multiplexor of their message.
  void find_only_multiplexors() {
    for (DbcMessage& m : dbc_.messages) {
      std::vector<const DbcSignal*> all;
      for (const DbcSignal& s : m.signals)
        if (s.is_multiplexor) all.push_back(&s);
      for (DbcSignal& s : m.signals) {
        if (s.present_at.empty() || !s.multiplexor.empty()) continue;
        std::array<const DbcSignal*, 2> others{};
        for (std::size_t i = 0; i < all.size() && others[1] == nullptr; ++i)
          if (all[i] != &s) others[others[0] == nullptr ? 0 : 1] = all[i];
        if (others[0] == nullptr)
          m.contradictions.push_back(
              {s.line,
               fmt::format("signal {} is multiplexed and {} has no multiplexor", s.name, m.name)});
        else if (others[1] != nullptr)
          m.contradictions.push_back(
              {s.line, fmt::format("signal {}: {} has two multiplexors, {} and {}, and no "
                                   "SG_MUL_VAL_ names the one that "
                                   "switches it",
                                   s.name, m.name, others[0]->name, others[1]->name)});
        else
          s.multiplexor = others[0]->name;
      }
    }
  }

  DbcScanner scan_;
  FileProblems problems_;
  Dbc dbc_;
  std::int64_t line_ = 0;  ///< at which the statement begins
  std::optional<DbcMessage> open_;
  bool dropped_ = false;
  std::map<std::uint64_t, DbcMessage*> messages_;
  std::map<std::pair<std::uint64_t, std::string_view>, DbcSignal*> signals_;
  std::vector<FloatType> floats_;
  std::vector<Switched> switched_;
  std::map<std::uint64_t, double> cycles_;
};

}  // namespace

const DbcSignal* DbcMessage::find(const std::string& signal) const {
  for (const DbcSignal& s : signals)
    if (s.name == signal) return &s;
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
