#pragma once

#include <string>
#include <vector>

#include "daemon/config.h"
#include "daemon/toml_document.h"

namespace framewatch::daemon {

/// How far a change of the configuration reaches into an estimation that runs.
enum class Reach {
  settings,  ///< the window goes on under other settings
  window,    ///< its rows were weighted otherwise: the window begins anew
  restart,   ///< structure, channels, grid, messages: not while it runs
};

struct ConfigChange {
  std::string key;            ///< "estimator.min_snr", "channel[3].noise_mps2_per_rthz"
  std::string before, after;  ///< as TOML; empty: the key is not there
  TextPlace place;            ///< in the new file; line 0 when it is not there
  Reach reach = Reach::restart;

  /// "estimator.min_snr: 10 -> 12".
  std::string described() const;
};

/// Every value that differs between two configuration files, in the order of their keys. Layout,
/// comments and order of keys do not count.
std::vector<ConfigChange> changes_between(const TomlValue& before, const TomlValue& after);

/// Puts what may change in a running estimation into the configuration it runs with.
void take_settings(Config& running, const Config& fresh);

}  // namespace framewatch::daemon
