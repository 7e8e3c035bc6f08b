// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fleet/store/fleet_store.h"

namespace framewatch::fleet {

/// A day of an inventory (docs/fleet.md): the content of the building's history.
struct InventoryDay {
  std::int64_t from_us = 0;
  DayCounts counts;
};

/// Parses an inventory into ascending days. Returns an empty list if it is malformed or too long.
std::vector<InventoryDay> inventory_days(std::string_view json);

/// Returns the starts of days of which the database has fewer events or periods than the building's
/// newest inventory, newest first. Ignores the last day, which is not over. Returns nullopt if the
/// database fails.
std::optional<std::vector<std::int64_t>> missing_days(FleetStore& store,
                                                      const std::string& building);

struct WorkerArguments {
  std::vector<std::string> hubs;  ///< tls://HOST:PORT
  std::string directory = ".";    ///< with worker.pem, worker.key and ca.pem
  std::string database;           ///< connection string or URI of libpq
  bool quiet = false;
};

/// Runs `framewatch fleet worker` until SIGINT or SIGTERM. Returns the exit status.
int worker_command(const WorkerArguments& arguments);

}  // namespace framewatch::fleet
