// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/tools/init/draft.h"

namespace framewatch::daemon {

struct InitArguments {
  InitAnswers answers;
  std::string out = "building.toml";
  std::string drawing;  ///< SVG file of the plan; empty: none
  bool force = false;   ///< overwrite an existing file
  bool quiet = false;
};

/// Runs `framewatch init`: writes a configuration from answers, given as options or on a terminal.
/// Exit status: 0 written, 2 not written; everything missing or wrong is listed.
int init(const InitArguments& arguments);

}  // namespace framewatch::daemon
