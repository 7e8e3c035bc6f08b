#pragma once

#include <string>

namespace framewatch::daemon {

/// A share as text in per cent with two or three digits: "0.061 %", "12 %", "-" for NaN, "> 1000
/// %".
std::string percent(double share);
/// A share in per cent with one decimal: "94.3 %", for shares that are compared with a limit.
std::string percent_1(double share);

}  // namespace framewatch::daemon
