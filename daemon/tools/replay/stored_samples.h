// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/config/config.h"
#include "daemon/tools/replay/replay_survey.h"
#include "drivers/lcm/accel_intake.h"

namespace framewatch::daemon {

/// Reads every sample of a surveyed input in order. Samples of a record, log of CAN frames or raw
/// log go to `sink`, messages of an event log to `intake`, which has its own sink. Damaged parts of
/// a log are skipped. Returns an empty string, or the file and the error.
std::string push_stored_samples(const Config& config, const ReplayInput& input,
                                drivers::AccelIntake& intake,
                                const drivers::AccelIntake::Sink& sink);

}  // namespace framewatch::daemon
