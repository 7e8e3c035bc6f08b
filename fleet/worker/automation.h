#pragma once

#include <vector>

#include "fleet/message/message.h"
#include "fleet/store/fleet_store.h"

namespace framewatch::fleet {

/// What building automation is told of a batch, over the hub's MQTT: subject
/// framewatch.BUILDING.state (topic framewatch/BUILDING/state) for each heartbeat, which comes
/// every 60 s and when an event begins or ends, and framewatch.BUILDING.event for each event, as
/// JSON (docs/fleet.md). Of several heartbeats of one building the newest.
std::vector<Message> automation_messages(const FleetBatch& batch);

}  // namespace framewatch::fleet
