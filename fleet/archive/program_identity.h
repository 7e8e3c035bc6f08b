#pragma once

#include <string>

namespace framewatch::fleet {

/// SHA-256 that two programs share only when they do the same: of the version and the build id that
/// the linker made of the program's content; of the file where it has none. Empty when it cannot be
/// read.
std::string program_identity();

}  // namespace framewatch::fleet
