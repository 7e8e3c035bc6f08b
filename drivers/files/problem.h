#pragma once

#include <string>

namespace framewatch::drivers {

/// What went wrong with a file: place ("rec.csv:12" or "rec.csv") and rule.
struct Problem {
  std::string where;
  std::string message;
};

}  // namespace framewatch::drivers
