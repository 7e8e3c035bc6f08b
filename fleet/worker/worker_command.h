#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fleet/store/fleet_store.h"

namespace framewatch::fleet {

/// A day of an inventory (docs/fleet.md): what the building's history has of it.
struct InventoryDay {
  std::int64_t from_us = 0;
  DayCounts counts;
};

/// Days of an inventory, ascending; empty when it is none, or names more than there can be.
std::vector<InventoryDay> inventory_days(std::string_view json);

/// Begins of the days of which the database has fewer events or periods than the building's newest
/// inventory says, the newest first; the inventory's last day is not over and does not count.
/// Empty: the database is away.
std::optional<std::vector<std::int64_t>> missing_days(FleetStore& store,
                                                      const std::string& building);

struct WorkerArguments {
  std::vector<std::string> hubs;  ///< tls://HOST:PORT
  std::string directory = ".";    ///< with worker.pem, worker.key and ca.pem
  std::string database;           ///< connection string or URI of libpq
  bool quiet = false;
};

/// framewatch fleet worker: runs until SIGINT or SIGTERM.
int worker_command(const WorkerArguments& arguments);

}  // namespace framewatch::fleet
