// SPDX-License-Identifier: MIT
// Numbers as a person answers them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/tools/init/draft.h"

namespace framewatch::daemon {

// Questions about the start of tuning: a first natural frequency or period, stiffnesses, a rule of
// the field, or nothing. Used as members of InitQuestion.
std::string ask_start(const BuildingDraft& draft);
std::string initial_start(const BuildingDraft& draft);
std::string take_start(const std::string& text, BuildingDraft& draft, ColumnCache& files);

/// "4.2, 3.5 m": numbers, and what stands behind them.
struct Quantity {
  std::vector<double> values;
  std::string unit;  ///< without blanks; empty: none
};

/// Positive numbers between commas, then perhaps a unit. Empty for anything else, and for "3,5",
/// which can be one number or two.
std::optional<Quantity> parse_quantity(std::string_view text);
/// `rule`, or what helps where a comma can be read in two ways: "3,5".
std::string why_no_quantity(std::string_view text, const std::string& rule);

/// "6" or "6, 5, 6": the first for all of `count`, or one each. Empty: neither.
std::optional<std::vector<double>> spread(const std::vector<double>& values, std::size_t count);

/// "2x1".
struct Bays {
  int x = 0, y = 0;
};
std::optional<Bays> parse_bays(std::string_view text);

/// "3.5, 3.5"; equal ones once.
std::string list_text(const std::vector<double>& values);

}  // namespace framewatch::daemon
