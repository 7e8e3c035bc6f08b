// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/config/keys/section.h"
#include "daemon/config/sections/settings.h"
#include "drivers/dbc/dbc.h"

namespace framewatch::daemon {

/// A configured bus and the messages of its DBC files.
struct CanBusReading {
  ConfigSection section;
  std::vector<drivers::DbcMessage> messages;
  bool known = true;  ///< true if the DBC files could be read
};

/// Reads [[can]] and its DBC files into config.can.buses. `config.path` and the options must be
/// set.
std::vector<CanBusReading> read_can_buses(const TomlValue& document, Config& config,
                                          std::vector<TextProblem>& problems);

/// A signal with its message, or the reason why it was not found.
struct CanSignal {
  const drivers::DbcMessage* message = nullptr;
  const drivers::DbcSignal* signal = nullptr;
  std::string problem;
};

/// Finds "Message.Signal" in the DBC files of a bus.
CanSignal find_can_signal(const CanBusReading& bus, const std::string& text);
/// Returns the message, or null if `name` is unknown.
const drivers::DbcMessage* find_can_message(const CanBusReading& bus, const std::string& name);
std::string unknown_can_message(const CanBusReading& bus, const std::string& name);

}  // namespace framewatch::daemon
