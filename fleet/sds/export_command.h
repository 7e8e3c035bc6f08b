#pragma once

#include <string>

namespace framewatch::fleet {

struct ExportArguments {
  std::string database, root;
  std::string building;  ///< empty: every one
  std::string request;   ///< empty: every one
};

/// framewatch fleet export: raw samples that were fetched, as miniSEED in the folders of SDS.
int export_command(const ExportArguments& arguments);

}  // namespace framewatch::fleet
