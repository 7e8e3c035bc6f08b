#pragma once

#include <string>
#include <vector>

#include "estimator/diagnose/model/plant.h"

namespace framewatch::daemon {

struct DiagnoseArguments {
  std::string config;
  std::vector<std::string> train, holdout;  ///< record files and LCM event logs
  std::string event;  ///< id of a gap event whose stored samples are used instead of these files
  std::string out;    ///< directory of diagnosis.json, report.html, model.toml
  std::vector<std::string> without;  ///< names of effects that are never given
  estimator::ComponentTest component;
  int threads = 0;  ///< 0: as many as the machine has
  bool quiet = false;
};

/// framewatch diagnose. Exit code: 0 adequate or explained, 1 a gap remains, 2 bad usage or input.
int diagnose_command(const DiagnoseArguments& arguments);

}  // namespace framewatch::daemon
