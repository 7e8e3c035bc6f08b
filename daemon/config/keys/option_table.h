#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/keys/target.h"

namespace framewatch::daemon {

/// What a change of the configuration takes while an estimation runs; the later the more.
enum class Reach {
  settings,  ///< the window goes on under other settings
  window,    ///< its rows were weighted otherwise: the window begins anew
  restart,   ///< structure, channels, grid, messages: not while it runs
};

/// One key of a file. Its place in the settings, validation, default, documentation and what a
/// change of it takes are made from this entry alone: a new key is one entry and one field.
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
  std::optional<Reach> reload = {};  ///< every key of the configuration file has one, others none
  bool is_path = false;              ///< of a file or directory beside the configuration file
  Target target = {};                ///< field that ConfigSection::read_into fills
  std::string_view by_hand = "";     ///< without a target: why reading it takes code of its own
};

/// The tables, one function each, in the order of docs/configuration.md's sections where these do
/// not say otherwise (section_table.h).
std::span<const Option> structure_options();
std::span<const Option> channel_options();
std::span<const Option> estimator_options();
std::span<const Option> lcm_options();
std::span<const Option> command_options();
std::span<const Option> can_options();
std::span<const Option> watch_options();  ///< and the baseline file's
std::span<const Option> gap_options();
std::span<const Option> history_options();
std::span<const Option> event_report_options();
std::span<const Option> fragility_options();
std::span<const Option> action_options();
std::span<const Option> fleet_options();
std::span<const Option> scenario_options();
std::span<const Option> effect_options();  ///< of configuration and scenario files
std::span<const Option> expectation_options();

/// All of them, in that order.
std::span<const Option> options();

/// Null when the section has no such key.
const Option* find_option(std::string_view section, std::string_view key);

std::vector<std::string> choices(const Option& option);

/// "> 0 and <= 10 s", "one of a, b"; empty when anything goes.
std::string constraint(const Option& option);

/// "a number (kg)", "true or false": what a value of the option is.
std::string expected(const Option& option);

}  // namespace framewatch::daemon
