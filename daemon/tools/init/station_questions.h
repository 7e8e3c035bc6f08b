#pragma once

#include "daemon/tools/init/draft.h"

namespace framewatch::daemon {

/// Gives every channel of a station its place, from its header or from NAME=PLACE of a person. What
/// neither says is open.
void place_station(const InitAnswers& answers, InitReading& reading);

}  // namespace framewatch::daemon
