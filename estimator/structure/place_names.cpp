#include "estimator/structure/place_names.h"

#include <algorithm>

namespace framewatch::estimator {

std::string crossing_name(const Structure& s, int crossing) {
  const int columns = std::max(s.m(), 1);
  return (s.m() > 0 ? s.frames_y[static_cast<std::size_t>(crossing % columns)] : "") +
         (s.n() > 0 ? s.frames_x[static_cast<std::size_t>(crossing / columns)] : "");
}

std::string panel_name(const Structure& s, int panel) {
  const int columns = s.m() - 1;
  return s.frames_y[static_cast<std::size_t>(panel % columns)] +
         s.frames_x[static_cast<std::size_t>(panel / columns)];
}

}  // namespace framewatch::estimator
