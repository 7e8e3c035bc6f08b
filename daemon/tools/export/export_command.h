// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

struct ExportArguments {
  std::string config;
  std::string opensees;              ///< folder for model.tcl and model.py; empty: none
  std::string matrices;              ///< folder for M, C and K; empty: none
  std::vector<std::string> without;  ///< names of effects to leave out
  bool force = false;                ///< write into folders that are not empty
  bool quiet = false;
};

/// Runs `framewatch export`: writes the model of a configuration, its design and effects, for other
/// programs. Exit status: 0 written, 2 nothing written; every problem is listed.
int export_command(const ExportArguments& arguments);

}  // namespace framewatch::daemon
