#pragma once

#include <string>

#include "daemon/config.h"
#include "daemon/replay_survey.h"
#include "drivers/accel_intake.h"

namespace framewatch::daemon {

/// Every sample of a surveyed input, in its order: a record's and those of a candump log go to
/// `sink`, an event log's messages to `intake`, whose own sink gets them. Damaged parts of a log
/// are passed over. Empty on success, else the file and what went wrong.
std::string push_stored_samples(const Config& config, const ReplayInput& input,
                                drivers::AccelIntake& intake,
                                const drivers::AccelIntake::Sink& sink);

}  // namespace framewatch::daemon
