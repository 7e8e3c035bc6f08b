#pragma once

#include <string>
#include <vector>

#include "daemon/config/keys/section.h"
#include "daemon/config/sections/settings.h"
#include "drivers/dbc/dbc.h"

namespace framewatch::daemon {

/// A bus of the configuration and what its DBC files say.
struct CanBusReading {
  ConfigSection section;
  std::vector<drivers::DbcMessage> messages;
  bool known = true;  ///< the DBC files could be read
};

/// [[can]] into config.can.buses, with the files read. `config.path` and the options are known.
std::vector<CanBusReading> read_can_buses(const TomlValue& document, Config& config,
                                          std::vector<TextProblem>& problems);

/// A signal with its message, or the problem that kept it from being found.
struct CanSignal {
  const drivers::DbcMessage* message = nullptr;
  const drivers::DbcSignal* signal = nullptr;
  std::string problem;
};

/// "Message.Signal" of a bus' DBC files.
CanSignal find_can_signal(const CanBusReading& bus, const std::string& text);
/// Null when there is none.
const drivers::DbcMessage* find_can_message(const CanBusReading& bus, const std::string& name);
std::string unknown_can_message(const CanBusReading& bus, const std::string& name);
/// ", did you mean X?" or nothing.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace framewatch::daemon
