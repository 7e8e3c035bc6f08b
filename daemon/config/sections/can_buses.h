#pragma once

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

}  // namespace framewatch::daemon
