#pragma once

#include <string>

namespace framewatch::daemon {

struct CheckArguments {
  std::string config;
  bool json = false;
  int advise = 0;                       ///< floors for further sensors to name
  bool print_effects_markdown = false;  ///< docs/effects.md
  bool print_options_markdown = false;  ///< docs/configuration.md instead of a check
};

/// Exit status: 0 the configuration is good, 2 it is not.
int check_command(const CheckArguments& arguments);

}  // namespace framewatch::daemon
