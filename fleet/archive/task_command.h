// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace framewatch::fleet {

struct TaskArguments {
  std::string manifest;
  std::vector<int> numbers;  ///< of the tasks to run
};

/// Runs `framewatch fleet task`: runs the tasks that are not done and prints one JSON line for
/// each. Returns the exit status: 1 if a task failed.
int task(const TaskArguments& arguments);

}  // namespace framewatch::fleet
