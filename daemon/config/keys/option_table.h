// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/keys/target.h"

namespace framewatch::daemon {

/// Cost of changing a key while an estimation runs, cheapest first.
enum class Reach {
  settings,  ///< the current window continues with the new settings
  window,    ///< the weights of the rows change, so the window starts again
  restart,   ///< structure, channels, grid or messages change; the program must be restarted
};

/// One key of a file. Reading, validation, documentation and reloading all follow from this entry;
/// the default comes from the target's field. A new key is one entry and one field.
struct Option {
  std::string_view section;  ///< "structure", "structure.design", "channel", "channel.source", ...
  std::string_view key;
  OptionType type = OptionType::number;
  std::string_view unit = "";
  std::string_view shape = "";     ///< shape of a grid or list, for readers: "[story][y][x]"
  std::string default_value = {};  ///< in TOML; empty: options() takes it from the target's field
  std::string paper_default = {};  ///< default for variant = "paper", if it differs
  bool no_default = false;         ///< optional, and the field's initial value is not a default
  bool required = false;
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;         ///< values must exceed min
  std::string_view choices = "";  ///< allowed texts, separated by |
  std::string_view meaning = "";
  std::optional<Reach> reload = {};  ///< set for every key of the configuration file, and no other
  bool is_path = false;              ///< a path relative to the configuration file
  Target target = {};                ///< field that ConfigSection::read_into fills
  std::string_view by_hand = "";     ///< without a target: why special code reads the key
};

/// The tables, in the order of docs/configuration.md unless section_table.h gives another order.
/// Their rows lack the defaults that options() adds.
std::span<const Option> structure_options();
std::span<const Option> channel_options();
std::span<const Option> estimator_options();
std::span<const Option> lcm_options();
std::span<const Option> command_options();
std::span<const Option> can_options();
std::span<const Option> watch_options();  ///< also the keys of baseline files
std::span<const Option> gap_options();
std::span<const Option> history_options();
std::span<const Option> event_report_options();
std::span<const Option> fragility_options();
std::span<const Option> action_options();
std::span<const Option> fleet_options();
std::span<const Option> scenario_options();
std::span<const Option> effect_options();  ///< for configuration and scenario files
std::span<const Option> expectation_options();

/// Returns the rows of all tables, in that order, with the defaults of their targets' fields.
std::span<const Option> options();

/// Returns the option, or null if `section` has no such key.
const Option* find_option(std::string_view section, std::string_view key);

/// Returns the texts that a choice allows.
std::vector<std::string> choices(const Option& option);

/// Returns the allowed values: "> 0 and <= 10 s", "one of a, b". Empty if all are allowed.
std::string constraint(const Option& option);

/// Returns the kind of value that the option expects: "a number (kg)", "true or false".
std::string expected(const Option& option);

namespace fields_detail {
void place_files(std::string_view section, const void* owner, std::string_view directory,
                 void* settings);
void take_reloadable(std::string_view section, const void* owner, const void* from, void* to);
}  // namespace fields_detail

/// Puts `directory` before the relative paths in the fields of a section's keys.
template <class Settings>
void place_files(std::string_view section, std::string_view directory, Settings& settings) {
  fields_detail::place_files(section, &kOwner<Settings>, directory, &settings);
}

/// Copies the fields of the section's keys whose change needs no restart.
template <class Settings>
void take_reloadable(std::string_view section, const Settings& from, Settings& to) {
  fields_detail::take_reloadable(section, &kOwner<Settings>, &from, &to);
}

}  // namespace framewatch::daemon
