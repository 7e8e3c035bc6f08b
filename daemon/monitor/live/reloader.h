#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/base/toml_document.h"
#include "daemon/config/changes.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/config/sections/settings.h"
#include "daemon/monitor/live/service_report.h"

namespace framewatch::daemon {

/// Reads the configuration of a running estimation anew. A file that is wrong, or that changes what
/// cannot change while it runs, changes nothing: the log says why, line by line.
class Reloader {
 public:
  /// text: what `config` was made of.
  Reloader(const Config& config, const std::string& text);

  struct Result {
    Config config;  ///< a new one: the running one with what may change while it runs
    Reach reach = Reach::settings;
  };
  /// Empty when the file was refused.
  std::optional<Result> read(const Config& running);
  const ReloadCount& count() const { return count_; }

 private:
  std::optional<Result> refuse(const std::vector<ConfigProblem>& problems);

  std::string path_;
  TomlValue document_;
  ReloadCount count_;
};

}  // namespace framewatch::daemon
