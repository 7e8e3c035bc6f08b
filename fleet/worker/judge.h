#pragma once

#include <cstdint>
#include <string>

#include "fleet/message/message.h"
#include "fleet/store/fleet_store.h"

namespace framewatch::fleet {

/// Adds what a message of a building is to `batch`. What breaks a rule goes to `others` with the
/// reason, a type that this program does not know without one:
///   the subject is fw.up.<building>.<kind>, the key (Nats-Msg-Id) names the same building,
///   type and content fit the kind, and the key is the one that the content has,
///   a summary begins after 1970 and before the day after `hub_us` (UTC).
void judge(const Message& message, std::int64_t hub_us, FleetBatch& batch);

}  // namespace framewatch::fleet
