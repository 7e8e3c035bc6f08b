#pragma once

#include <map>
#include <string>
#include <vector>

#include "daemon/base/toml_document.h"
#include "daemon/config/keys/option_table.h"
#include "daemon/config/sections/settings.h"

namespace framewatch::daemon {

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

/// SHA-256 of the values of each section of a file, by its name: "estimator", "channel". Layout,
/// comments and order of keys do not count.
std::map<std::string, std::string> section_digests(const TomlValue& document);

/// A new configuration: the running one with everything of the fresh one that may change while an
/// estimation runs. `fresh` differs from `running` in nothing that takes a restart.
Config reloaded(const Config& running, const Config& fresh);

}  // namespace framewatch::daemon
