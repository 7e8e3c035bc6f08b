#pragma once

#include <string>

namespace framewatch::daemon {

/// CSS of every plot: seven colours that remain apart without red-green vision (0 blue, 1
/// vermilion, 2 green, 3 purple, 4 orange, 5 sky, 6 grey), for light, dark and paper.
std::string svg_style();

}  // namespace framewatch::daemon
