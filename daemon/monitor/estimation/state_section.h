#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace framewatch::daemon {

/// A part of an estimation's state that is read by itself (docs/formats.md).
struct StateSection {
  std::string name;
  std::vector<std::uint8_t> bytes;
};

/// A section that was not taken from a state file.
struct LostSection {
  std::string name;
  std::string why;  ///< "its digest is another"
};

/// What an estimation does without a section, for a person: "the window begins anew". Empty for a
/// name that is not a section's.
std::string_view without_section(std::string_view name);

/// The sections of the configuration file, and the further properties in StateGrounds, that a
/// section of the state depends on. It is refused when one of them has changed.
const std::vector<std::string>& grounds_of_section(std::string_view name);

}  // namespace framewatch::daemon
