#pragma once

#include <string>

namespace framewatch::daemon {

/// "25.02 ± 0.14": two digits of the error, and the value to the same place.
std::string with_error(double value, double std_error);
/// "-25.0 ± 0.1": a change in %, to the tenth that no error is below.
std::string change_with_error(double ratio, double std_error);

}  // namespace framewatch::daemon
