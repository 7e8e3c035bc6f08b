// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace framewatch::daemon {

/// Explains a line that the TOML parser rejects: in plain words for known mistakes, else as
/// `description`, the parser's message. `column` is the mistake's character from 1; it is moved if
/// a better place is known.
std::string toml_advice(const std::string& description, std::string_view line, int& column);

/// Line and column in a text, from 1. Line 0 means no particular place.
struct TextPlace {
  int line = 0;
  int column = 0;
};

enum class TomlKind { text, integer, number, boolean, array, table, date };

struct TomlEntry;

/// A value of a TOML file and its place.
struct TomlValue {
  TomlKind kind = TomlKind::table;
  TextPlace place;
  std::string text;
  double number = 0;  ///< also set for integers
  std::int64_t integer = 0;
  bool boolean = false;
  std::vector<TomlValue> items;    ///< of an array
  std::vector<TomlEntry> entries;  ///< of a table, in the order of the file

  /// Returns the entry of a table, or null if `key` is missing.
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

/// Returns the tables of [[name]] in `table`, or none if it is absent. Appends a problem if it is
/// something else.
std::vector<const TomlValue*> tables_of(const TomlValue& table, std::string_view name,
                                        std::vector<TextProblem>& problems);

/// Parses TOML 1.0. Keeps the first of two equal keys and appends a problem. Returns nullopt and
/// appends a problem after any other syntax error.
std::optional<TomlValue> parse_toml(std::string text, std::vector<TextProblem>& problems);

}  // namespace framewatch::daemon
