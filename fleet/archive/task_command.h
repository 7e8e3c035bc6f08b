#pragma once

#include <string>
#include <vector>

namespace framewatch::fleet {

struct TaskArguments {
  std::string manifest;
  std::vector<int> numbers;  ///< of tasks
};

/// framewatch fleet task: does tasks of a manifest that are not done, and says of each one JSON
/// line. Exit status: 1 when one failed.
int task(const TaskArguments& arguments);

}  // namespace framewatch::fleet
