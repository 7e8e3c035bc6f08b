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

/// Allowed values of a number.
struct OptionRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;  ///< values must exceed min
};

/// Returns the range of values that exceed `min`.
constexpr OptionRange above(double min, double max = std::numeric_limits<double>::infinity()) {
  return {min, max, true};
}

/// One key of a file. Reading, validation, documentation and reloading all follow from this entry;
/// the default comes from the target's field. A new key is one entry and one field.
struct Option {
  std::string_view section = "";  ///< "structure", "channel.source", ...; set by options()
  std::string_view key;
  /// options() sets it if it follows from the rest: choice with choices, grid with a shape, or the
  /// type of the target's field.
  OptionType type = OptionType::number;
  std::string_view unit = "";
  std::string_view shape = "";     ///< shape of a grid or list, for readers: "[story][y][x]"
  std::string default_value = {};  ///< in TOML; empty: options() takes it from the target's field
  std::string paper_default = {};  ///< default for variant = "paper", if it differs
  bool no_default = false;         ///< optional, and the field's initial value is not a default
  bool required = false;
  OptionRange range = {};
  std::string_view choices = "";  ///< allowed texts, separated by |
  std::string_view meaning = "";
  /// Only for keys of the configuration file. Empty: that of the OptionSection.
  std::optional<Reach> reload = {};
  bool is_path = false;           ///< a path relative to the configuration file
  Target target = {};             ///< field that ConfigSection::read_into fills
  std::string_view by_hand = "";  ///< without a target: why special code reads the key
};

/// Rows of a section. A section may have several lists of rows.
struct OptionSection {
  std::string_view section;
  std::span<const Option> rows;
  std::optional<Reach> reload = {};  ///< Option::reload of rows without one
};

/// The tables, in the order of docs/configuration.md unless section_table.h gives another order.
/// Their rows lack the fields that options() sets.
std::vector<OptionSection> structure_options();
std::vector<OptionSection> channel_options();
std::vector<OptionSection> estimator_options();
std::vector<OptionSection> lcm_options();  ///< also of [commands]
std::vector<OptionSection> can_options();
std::vector<OptionSection> watch_options();  ///< also of [gap] and baseline files
std::vector<OptionSection> weather_options();
std::vector<OptionSection> history_options();
std::vector<OptionSection> event_report_options();  ///< also of [fragility]
std::vector<OptionSection> action_options();        ///< also of [email] and [report]
std::vector<OptionSection> fleet_options();
std::vector<OptionSection> scenario_options();
std::vector<OptionSection> effect_options();  ///< for configuration and scenario files
std::vector<OptionSection> expectation_options();
std::vector<OptionSection> about_options();

/// Returns the rows of all tables, in that order and complete.
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
