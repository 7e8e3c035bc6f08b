// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/base/svg_plot.h"
#include "daemon/tools/report/record_modes.h"

namespace framewatch::daemon {

/// Returns a picture of each mode, named "mode-1" + suffix, by the rows of the table: the building
/// at rest, the identified and the design's shape, and the measured one at the channels that sit on
/// a frame. Shapes are scaled to fit the identified one. The files' CSV has them by floor and
/// frame.
std::vector<Picture> mode_pictures(const RecordModes& modes, const std::string& suffix);

}  // namespace framewatch::daemon
