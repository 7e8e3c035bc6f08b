// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::earthquake {

/// A requirement, and whether it holds.
struct Demand {
  std::string text;
  bool holds = false;
};

}  // namespace framewatch::earthquake
