// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "daemon/base/toml_document.h"
#include "daemon/config/changes.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/config/sections/settings.h"

namespace framewatch::daemon {

/// The outcome of the requests to reload the configuration.
struct ReloadCount {
  std::int64_t done = 0, refused = 0;
  std::string problem;  ///< why the newest one was refused; empty: accepted
};

/// Reads the configuration file of a running estimation again. A file that is invalid, or that
/// changes settings that need a restart, is refused: the log says why, line by line.
class Reloader {
 public:
  /// `text` is the source of `config`.
  Reloader(const Config& config, const std::string& text);

  struct Result {
    Config config;  ///< the running one with the settings that may change at run time
    Reach reach = Reach::settings;
  };
  /// Returns nullopt if the file was refused.
  std::optional<Result> read(const Config& running);
  const ReloadCount& count() const { return count_; }

 private:
  std::optional<Result> refuse(const std::vector<ConfigProblem>& problems);

  std::string path_;
  TomlValue document_;
  ReloadCount count_;
};

}  // namespace framewatch::daemon
