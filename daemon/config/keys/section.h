#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/base/toml_document.h"
#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {

/// One table of the configuration file, checked against its section of the option table when it is
/// made. Afterwards a key has its value, or its default when it is absent or has a problem.
/// Asking for a key the option table does not have is a programmer's error.
class ConfigSection {
 public:
  /// `table` null: the file does not have it, everything is at its default and required keys are
  /// reported at `where`. Messages begin with `label`.
  ConfigSection(std::string_view section, std::string label, const TomlValue* table,
                TextPlace where, std::vector<TextProblem>& problems);

  /// Given, and without a problem so far.
  bool given(std::string_view key) const;
  /// Without a problem so far; absent is good unless the key is required.
  bool good(std::string_view key) const { return !bad_.contains(std::string(key)); }
  double number(std::string_view key) const;
  int integer(std::string_view key) const;
  bool boolean(std::string_view key) const;
  std::string text(std::string_view key) const;
  std::vector<std::string> texts(std::string_view key) const;
  /// Values of a grid of these sizes, flattened, last index fastest; empty after a problem. A
  /// dimension of size 1 may be left out of the file's nesting.
  std::vector<double> grid(std::string_view key, const std::vector<int>& sizes);
  /// Numbers of a grid with one dimension of any length, or its default; empty after a problem.
  std::vector<double> list(std::string_view key);
  /// From here on a key that has another default in the paper's variant has that one.
  void use_paper_defaults() { paper_defaults_ = true; }
  /// Every key whose target is a field of `Settings` goes there; a choice that is absent and has no
  /// default, and a list with a problem, leave the field as it is.
  template <class Settings>
  void read_into(Settings& settings) {
    store(&kOwner<Settings>, &settings);
  }
  const TomlValue* value(std::string_view key) const;
  TextPlace where() const { return where_; }

  /// Reports at the key's value, or at the table when the key is absent or empty.
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
