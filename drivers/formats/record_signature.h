#pragma once

#include <optional>

#include "drivers/files/file_problems.h"
#include "drivers/records/record_options.h"

namespace framewatch::drivers {

/// The format of a file that is no text, told by its first bytes; empty: it may be text. A format
/// that is known and not read (MDF, UFF, HDF5, miniSEED 3, full SEED) is a problem that says what
/// helps.
std::optional<RecordFormat> format_by_signature(FileProblems& problems);

}  // namespace framewatch::drivers
