// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::daemon {

struct CheckArguments {
  std::string config;
  bool json = false;
  int advise = 0;                       ///< largest number of advised floors
  bool print_effects_markdown = false;  ///< docs/effects.md
  bool print_options_markdown = false;  ///< docs/configuration.md instead of a check
};

/// Runs `framewatch check`. Returns 0 if the configuration is good, else 2.
int check_command(const CheckArguments& arguments);

}  // namespace framewatch::daemon
