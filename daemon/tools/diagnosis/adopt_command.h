// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::daemon {

struct AdoptArguments {
  std::string config, model;
  bool quiet = false;
};

/// Runs `framewatch adopt`: copies a model of the configuration's building to its [gap] model path.
/// Returns the exit code: 0 done; 2 bad usage, configuration or model, nothing is changed.
int adopt(const AdoptArguments& arguments);

}  // namespace framewatch::daemon
