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
  /// What adding or removing it as a whole takes, without a key; only a section of the
  /// configuration file has this.
  std::optional<Reach> reload = {};
};

/// Every section, in the order of docs/configuration.md.
std::span<const SectionDescription> section_table();

/// Null when there is none of this name.
const SectionDescription* find_section(std::string_view section);

}  // namespace framewatch::daemon
