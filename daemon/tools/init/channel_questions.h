#pragma once

#include "daemon/tools/init/draft.h"

namespace framewatch::daemon {

/// Gives every place of the building its channel: by NAME=PLACE, by the columns' titles where they
/// can be read in one way, by number where nobody named them; of a station by its headers. What is
/// left is open.
void place_channels(const InitAnswers& answers, InitReading& reading);

}  // namespace framewatch::daemon
