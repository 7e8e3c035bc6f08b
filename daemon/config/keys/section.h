// SPDX-License-Identifier: MIT
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/toml_document.h"
#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {

/// One table of the configuration file. The constructor checks it against its section of the option
/// table. Then each key has its value, or its default if it is absent or has a problem. Asking for
/// a key that is not in the option table is a programming error.
class ConfigSection {
 public:
  /// With a null `table` everything has its default, and missing required keys are reported at
  /// `where`. Messages begin with `label`.
  ConfigSection(std::string_view section, std::string label, const TomlValue* table,
                TextPlace where, std::vector<TextProblem>& problems);
  /// Reads the document's table of that name, which may be absent.
  ConfigSection(std::string_view section, const TomlValue& document,
                std::vector<TextProblem>& problems);

  /// Returns true if the key is given and has no problem so far.
  bool given(std::string_view key) const;
  /// Returns true if the key has no problem so far. An absent key is good unless it is required.
  bool good(std::string_view key) const { return !bad_.contains(std::string(key)); }
  /// Returns true if no key of the table has a problem so far.
  bool good() const { return bad_.empty(); }
  double number(std::string_view key) const;
  int integer(std::string_view key) const;
  bool boolean(std::string_view key) const;
  std::string text(std::string_view key) const;
  std::vector<std::string> texts(std::string_view key) const;
  /// Returns the values of a grid of these sizes, flattened, last index fastest. Returns an empty
  /// list after a problem. The file's nesting may leave out dimensions of size 1.
  std::vector<double> grid(std::string_view key, const std::vector<int>& sizes);
  /// Returns the numbers of a one-dimensional grid of any length, or its default. Returns an empty
  /// list after a problem.
  std::vector<double> list(std::string_view key);
  /// Uses the defaults of the paper's variant from now on.
  void use_paper_defaults() { paper_defaults_ = true; }
  /// Stores every key whose target is a field of `Settings`. Leaves the field unchanged for an
  /// absent choice without default and for a list with a problem.
  template <class Settings>
  void read_into(Settings& settings) {
    store(&kOwner<Settings>, &settings);
  }
  /// Returns new settings after read_into().
  template <class Settings>
  Settings read() {
    Settings settings;
    read_into(settings);
    return settings;
  }
  const TomlValue* value(std::string_view key) const;
  TextPlace where() const { return where_; }

  /// Reports a problem at the key's value, or at the table if the key is absent or empty.
  void problem(std::string_view key, const std::string& message);

 private:
  const Option& option(std::string_view key) const;
  std::string default_of(std::string_view key) const;
  void store(const void* owner, void* settings);
  bool is_subsection(std::string_view key) const;
  void check_keys();
  void check_value(const Option& option, const TomlValue& value);
  void check_number(const Option& option, const TomlValue& value);
  void check_leaves(const Option& option, const TomlValue& value);
  void report(const Option& option, TextPlace place, const std::string& message);

  std::string_view section_;
  std::string label_;
  const TomlValue* table_;
  TextPlace where_;
  std::vector<TextProblem>* problems_;
  std::set<std::string> bad_;
  bool paper_defaults_ = false;
};

}  // namespace framewatch::daemon
