// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/base/picture_files.h"
#include "daemon/tools/compare/compared_run.h"
#include "daemon/tools/compare/comparison.h"

namespace framewatch::daemon {

struct CompareArguments {
  std::vector<std::string> sources;  ///< at least two, see read_run()
  RunOptions options;
  DifferenceLimits limits;
  std::string out;    ///< page; empty: no page
  std::string about;  ///< file for the head of the page, see read_about(); may be empty
  PictureFiles figures;
  bool json = false;
  bool quiet = false;
};

/// Runs `framewatch compare`. Returns the exit code: 0 when no stiffness and no natural frequency
/// differs, 1 when one does or no stiffness could be judged, kBadInput when a source cannot be read
/// or the buildings are unlike.
int compare(const CompareArguments& arguments);

}  // namespace framewatch::daemon
