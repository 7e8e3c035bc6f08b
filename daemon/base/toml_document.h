#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace framewatch::daemon {

/// What is wrong with a line that the parser of TOML does not understand, in a person's words where
/// it is a known mistake, else in the parser's. description: the parser's. column: of the mistake,
/// characters from 1; moved to where it is when that is known better.
std::string toml_advice(const std::string& description, std::string_view line, int& column);

/// Line and column in a text, from 1; line 0: no particular place.
struct TextPlace {
  int line = 0;
  int column = 0;
};

enum class TomlKind { text, integer, number, boolean, array, table, date };

struct TomlEntry;

/// A value of a TOML file with the place where it stands.
struct TomlValue {
  TomlKind kind = TomlKind::table;
  TextPlace place;
  std::string text;
  double number = 0;  ///< of an integer too
  std::int64_t integer = 0;
  bool boolean = false;
  std::vector<TomlValue> items;    ///< of an array
  std::vector<TomlEntry> entries;  ///< of a table, in the order of the file

  /// Entry of a table; null when there is none.
  const TomlEntry* find(std::string_view key) const;
  /// As a message names it: `the text "5 s"`, `-3`, `a list of 2`.
  std::string described() const;
};

struct TomlEntry {
  std::string key;
  TextPlace place;  ///< of the key
  TomlValue value;
};

struct TextProblem {
  TextPlace place;
  std::string message;
  std::string elsewhere = {};  ///< file:line in another file, in place of `place`
};

/// Tables of [[name]] in `table`; a problem when it is something else, none when it is absent.
std::vector<const TomlValue*> tables_of(const TomlValue& table, std::string_view name,
                                        std::vector<TextProblem>& problems);

/// Parses TOML 1.0. A key given twice is a problem and the first is kept; any other error of syntax
/// ends the reading with an empty optional.
std::optional<TomlValue> parse_toml(std::string text, std::vector<TextProblem>& problems);

}  // namespace framewatch::daemon
