#pragma once

#include <string>

namespace framewatch::daemon {

/// Where the parameter of a name (estimator::Parameter) is: "story 1, frame y2", "floor 2, panel
/// x1y1", "stories 6 to 12, along x", "stories 6 to 12, frame y1", "frames along x".
std::string place_words(const std::string& parameter);

/// What it is of: "frame y2 of story 1", "floor panel x1y1 of floor 2", "stories 6 to 12 along x",
/// "frame y1 of stories 6 to 12", "bending of frames along x".
std::string element_words(const std::string& parameter);

}  // namespace framewatch::daemon
