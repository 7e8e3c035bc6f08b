#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace framewatch::fleet {

/// Returns true for 1 to 32 of a-z, 0-9 and -, except "all", which addresses every building.
bool is_building_name(std::string_view name);

/// Returns fw.up.<building>.<kind>, for messages of a building. A kind may have dots: summary.600,
/// raw.17.
std::string up_subject(std::string_view building, std::string_view kind);
/// Returns fw.down.<building>.<verb>, for commands. building: "all" addresses every building.
std::string down_subject(std::string_view building, std::string_view verb);

/// The parts of a subject.
struct SubjectParts {
  std::string building, kind;  ///< kind: or verb
};
/// Return nullopt if `subject` has another form.
std::optional<SubjectParts> up_parts(std::string_view subject);
std::optional<SubjectParts> down_parts(std::string_view subject);

}  // namespace framewatch::fleet
