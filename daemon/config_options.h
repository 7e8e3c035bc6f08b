#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace framewatch::daemon {

/// grid: a number, which stands for all, or nested lists of numbers.
enum class OptionType { text, choice, integer, number, boolean, texts, grid, table };

/// One key of the configuration file. Parsing, validation, defaults and docs/configuration.md are
/// made from this table alone.
struct Option {
  std::string_view section;  ///< "structure", "structure.design", "channel", "channel.source", ...
  std::string_view key;
  OptionType type = OptionType::number;
  std::string_view unit = "";
  std::string_view shape = "";          ///< of a grid or list, for people: "[story][y][x]"
  std::string_view default_value = "";  ///< as TOML writes it; empty: none
  std::string_view paper_default = "";  ///< when another one holds for variant = "paper"
  bool required = false;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;         ///< min itself is not allowed
  std::string_view choices = "";  ///< allowed texts, separated by |
  std::string_view meaning = "";
};

/// Of the configuration file, then of the scenario file, then of [[effect]], which both may have,
/// then of the expectation file; [watch] of the configuration file and the baseline file.
std::span<const Option> options();
std::span<const Option> effect_options();
std::span<const Option> scenario_options();
std::span<const Option> expectation_options();
std::span<const Option> can_options();
std::span<const Option> watch_options();
std::span<const Option> gap_options();
std::span<const Option> history_options();
std::span<const Option> action_options();

/// Null when the section has no such key.
const Option* find_option(std::string_view section, std::string_view key);

std::vector<std::string> choices(const Option& option);

/// "> 0 and <= 10 s", "one of a, b"; empty when anything goes.
std::string constraint(const Option& option);

/// "a number (kg)", "true or false": what a value of the option is.
std::string expected(const Option& option);

}  // namespace framewatch::daemon
