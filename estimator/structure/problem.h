#pragma once

#include <string>

namespace framewatch::estimator {

/// One broken rule of a description, and which part of the description broke it.
struct Problem {
  std::string field;  ///< configuration key of the part; empty when a part is missing altogether
  int index = -1;     ///< of the sensor axis; -1 for the structure
  std::string message;
};

}  // namespace framewatch::estimator
