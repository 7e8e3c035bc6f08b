#pragma once

#include "daemon/tools/init/draft.h"

namespace framewatch::daemon {

/// Takes the answers one after the other, each judged by those before it. `take_defaults`: what is
/// not answered and has a default is not open. The plan is whole when nothing is open.
InitReading read_answers(const InitAnswers& answers, bool take_defaults, ColumnCache& files);

}  // namespace framewatch::daemon
