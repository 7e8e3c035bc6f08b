// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

namespace framewatch::daemon {

/// The newest value of every parameter with its standard error and the end of its window; 0: none
/// has come. Empty before the first estimate.
struct NewestValues {
  std::vector<double> value, std_error;
  std::vector<std::int64_t> end_us;
};

}  // namespace framewatch::daemon
