// SPDX-License-Identifier: MIT
#pragma once

#include "daemon/tools/init/draft.h"

namespace framewatch::daemon {

/// Assigns a channel to every place of the building: by NAME=PLACE, by column titles if they have
/// one reading, and by number for unnamed columns. Gives every channel of a station its place, from
/// NAME=PLACE or its header. The rest stays open.
void place_channels(const InitAnswers& answers, InitReading& reading);

}  // namespace framewatch::daemon
