// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "estimator/diagnose/model/plant.h"

namespace framewatch::daemon {

struct DiagnoseArguments {
  std::string config;
  std::vector<std::string> train, holdout;  ///< record files and LCM event logs
  std::string event;                 ///< id of a gap event whose stored samples replace these files
  std::string out;                   ///< directory for diagnosis.json, report.html, model.toml
  std::vector<std::string> without;  ///< names of effects to exclude
  estimator::ComponentTest component;
  int threads = 0;  ///< 0: as many as the machine has
  bool quiet = false;
};

/// Runs `framewatch diagnose`. Returns the exit code: 0 adequate or explained, 1 a gap remains, 2
/// bad usage or input.
int diagnose_command(const DiagnoseArguments& arguments);

}  // namespace framewatch::daemon
