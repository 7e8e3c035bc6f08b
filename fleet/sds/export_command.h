// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::fleet {

struct ExportArguments {
  std::string database, root;
  std::string building;  ///< empty: all buildings
  std::string request;   ///< empty: all requests
};

/// Runs `framewatch fleet export`: writes fetched raw samples as miniSEED into SDS folders. Returns
/// the exit status.
int export_command(const ExportArguments& arguments);

}  // namespace framewatch::fleet
