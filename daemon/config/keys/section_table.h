// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "daemon/config/keys/option_table.h"

namespace framewatch::daemon {

/// docs/configuration.md, made from the option table.
std::string options_markdown();

/// One section of a file, as the documentation and messages present it.
struct SectionDescription {
  std::string_view section;  ///< as in Option::section
  std::string_view heading;  ///< as it is written in the file: "[structure]", "[[channel]]"
  std::string_view text;
  /// Cost of adding or removing the section without a key. Only sections of the configuration file
  /// have one.
  std::optional<Reach> reload = {};
};

/// Every section, in the order of docs/configuration.md.
std::span<const SectionDescription> section_table();

/// Returns the section, or null if the name is unknown.
const SectionDescription* find_section(std::string_view section);

}  // namespace framewatch::daemon
