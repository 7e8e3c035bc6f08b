#pragma once

#include <string>
#include <vector>

#include "daemon/base/toml_document.h"

namespace framewatch::daemon {

struct GridReading {
  std::vector<double> values;  ///< flattened, last index fastest
  TextPlace place;             ///< of the problem
  std::string problem;         ///< empty when the values are good
};

/// Nested lists of numbers of these sizes; a number alone stands for all. Dimensions of size 1 may
/// be left out of the nesting, so that [story][frame] is good for a plane building's [story][y][x].
GridReading read_grid(const TomlValue& value, const std::vector<int>& sizes);

/// "2 x 3 x 3"
std::string size_text(const std::vector<int>& sizes);

}  // namespace framewatch::daemon
