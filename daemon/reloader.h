#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/config.h"
#include "daemon/config_changes.h"
#include "daemon/service_report.h"
#include "daemon/toml_document.h"

namespace framewatch::daemon {

/// Reads the configuration of a running estimation anew. A file that is wrong, or that changes what
/// cannot change while it runs, changes nothing: the log says why, line by line.
class Reloader {
 public:
  /// text: what `config` was made of.
  Reloader(const Config& config, const std::string& text);

  struct Result {
    Config config;
    Reach reach = Reach::settings;
  };
  /// Empty when there is nothing to do, or it was refused.
  std::optional<Result> read();
  const ReloadCount& count() const { return count_; }

 private:
  std::optional<Result> refuse(const std::vector<ConfigProblem>& problems);

  std::string path_;
  TomlValue document_;
  ReloadCount count_;
};

}  // namespace framewatch::daemon
