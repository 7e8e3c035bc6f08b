#pragma once

#include <string>

#include "daemon/tools/init/draft.h"

namespace framewatch::daemon {

struct InitArguments {
  InitAnswers answers;
  std::string out = "building.toml";
  bool force = false;  ///< write over a file that is there
  bool quiet = false;
};

/// framewatch init: a configuration from answers, given as options or asked for on a terminal. Exit
/// status: 0 written, 2 not, with everything that is missing or wrong.
int init(const InitArguments& arguments);

}  // namespace framewatch::daemon
