#pragma once

#include <string>
#include <vector>

namespace framewatch::daemon {

struct ReplayArguments;

/// Whether one of the outputs is named -.
bool writes_standard_output(const ReplayArguments& arguments);

/// Whether an output is the tables of a history.
bool is_history(const std::string& out);

/// What can be said before any file is read.
std::vector<std::string> argument_problems(const ReplayArguments& arguments);

}  // namespace framewatch::daemon
