#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace framewatch::fleet {

/// 1 to 32 of a-z, 0-9 and -, and not "all", which commands to every building go to.
bool is_building_name(std::string_view name);

/// fw.up.<building>.<kind>: what a building says. A kind may have dots: summary.600, raw.17.
std::string up_subject(std::string_view building, std::string_view kind);
/// fw.down.<building>.<verb>: a command; building "all": to every one.
std::string down_subject(std::string_view building, std::string_view verb);

/// The parts of such a subject.
struct SubjectParts {
  std::string building, kind;  ///< kind: or verb
};
/// Empty when it is none.
std::optional<SubjectParts> up_parts(std::string_view subject);
std::optional<SubjectParts> down_parts(std::string_view subject);

}  // namespace framewatch::fleet
