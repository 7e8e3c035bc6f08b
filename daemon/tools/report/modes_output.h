// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/base/json.h"
#include "daemon/tools/report/record_modes.h"

namespace framewatch::daemon {

/// Returns a table for a terminal: one row per mode, then what the stretch and the columns are.
std::string modes_text(const RecordModes& modes);

/// Returns everything about the modes, for framewatch.modes/1 (docs/modes.md).
Json modes_json(const RecordModes& modes);

/// Writes one row per mode as CSV. Cells without a value are empty. Return an empty string, or the
/// reason of a failure; then no file is left.
std::string write_modes_csv(const RecordModes& modes, const std::string& path);
/// Writes the columns of the CSV as variables of a MATLAB file, and shapes as matrices of modes x
/// channels.
std::string write_modes_mat(const RecordModes& modes, const std::string& path);

}  // namespace framewatch::daemon
