// SPDX-License-Identifier: MIT
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
  std::string before, after;  ///< as TOML; empty if the key is absent
  TextPlace place;            ///< place in the new file; line 0 if absent
  Reach reach = Reach::restart;

  /// Returns "estimator.min_snr: 10 -> 12".
  std::string described() const;
};

/// Returns every value that differs between two configuration files, ordered by key. Ignores
/// layout, comments and the order of keys.
std::vector<ConfigChange> changes_between(const TomlValue& before, const TomlValue& after);

/// Returns the SHA-256 of the values of each section of a file, by its name: "estimator",
/// "channel". Ignores layout, comments and the order of keys.
std::map<std::string, std::string> section_digests(const TomlValue& document);

/// Returns the running configuration with those settings of `fresh` that may change while an
/// estimation runs. `fresh` must not differ from `running` in a key that needs a restart.
Config reloaded(const Config& running, const Config& fresh);

}  // namespace framewatch::daemon
