#pragma once

#include <string>

namespace framewatch::drivers {

/// Renames PATH.partial, which a run that was cut off left behind, to PATH.cut-off-N, so that the
/// next PartialFile of PATH does not remove it. The new name; empty: there is none to keep (a plain
/// file of the same user that is not empty and that no process writes).
std::string keep_cut_off(const std::string& path);

}  // namespace framewatch::drivers
