#pragma once

#include <string>
#include <vector>

namespace framewatch::fleet {

struct ManifestArguments {
  std::string config, folder;       ///< of the outputs
  std::vector<std::string> places;  ///< logs, or directories of a history
  int hours = 48;                   ///< of a task
  double warm_up_s = 3600;
};

/// framewatch fleet manifest: tasks to standard output, one a line.
int manifest(const ManifestArguments& arguments);

}  // namespace framewatch::fleet
