#pragma once

#include "daemon/tools/replay/replay_arguments.h"

namespace framewatch::daemon {

/// framewatch replay. Exit code: 1 when it is not as expected.
int replay(const ReplayArguments& arguments);

}  // namespace framewatch::daemon
