// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/base/toml_document.h"
#include "daemon/config/keys/section.h"
#include "daemon/config/sections/settings.h"
#include "drivers/dbc/dbc.h"

namespace framewatch::daemon {

/// A message and the path of its DBC file.
struct CanMessage : drivers::DbcMessage {
  std::string path;
};

/// A configured bus and the messages of its DBC files.
struct CanBusReading {
  ConfigSection section;
  std::vector<CanMessage> messages;
  bool known = true;  ///< true if the DBC files could be read
};

/// A signal with its message, or the reason why it was not found.
struct CanSignal {
  const CanMessage* message = nullptr;
  const drivers::DbcSignal* signal = nullptr;
  std::string problem;
};

/// Reads [[can]] and its DBC files into config.can.buses. `config.path` and the options must be
/// set.
std::vector<CanBusReading> read_can_buses(const TomlValue& document, Config& config,
                                          std::vector<TextProblem>& problems);

/// Returns the message, or null if `name` is unknown.
const CanMessage* find_can_message(const CanBusReading& bus, const std::string& name);
/// Returns the problem of a message that find_can_message() does not find.
std::string unknown_can_message(const CanBusReading& bus, const std::string& name);
/// Finds "Message.Signal" in the DBC files of a bus.
CanSignal find_can_signal(const CanBusReading& bus, const std::string& text);

}  // namespace framewatch::daemon
