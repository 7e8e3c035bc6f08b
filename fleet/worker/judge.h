// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include "fleet/message/message.h"
#include "fleet/store/fleet_store.h"

namespace framewatch::fleet {

/// Checks a message of a building and adds it to `batch`. Messages that break a rule go to `others`
/// with the reason; messages of an unknown type go there without a reason. The rules:
///   the subject is fw.up.<building>.<kind>, and the key (Nats-Msg-Id) names the same building;
///   type and content match the kind, and the key matches the content;
///   a summary begins after 1970 and before the day after `hub_us` (UTC).
void judge(const Message& message, std::int64_t hub_us, FleetBatch& batch);

}  // namespace framewatch::fleet
