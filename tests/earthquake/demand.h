// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::earthquake {

/// One line of what must be reached, and whether it is.
struct Demand {
  std::string text;
  bool holds = false;
};

}  // namespace framewatch::earthquake
