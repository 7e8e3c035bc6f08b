#pragma once

#include <string>
#include <string_view>

namespace framewatch::daemon {

/// What is wrong with a line that the parser of TOML does not understand, in a person's words where
/// it is a known mistake, else in the parser's. description: the parser's. column: of the mistake,
/// characters from 1; moved to where it is when that is known better.
std::string toml_advice(const std::string& description, std::string_view line, int& column);

}  // namespace framewatch::daemon
