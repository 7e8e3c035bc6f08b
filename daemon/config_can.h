#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/config.h"
#include "daemon/config_section.h"
#include "drivers/can/dbc.h"

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

/// [[can]], [[can_node]] and the sources of the channels into config.can. Problems of a DBC file
/// are told at their place in it.
void read_can(const TomlValue& document, Config& config, std::vector<TextProblem>& problems);

}  // namespace framewatch::daemon
