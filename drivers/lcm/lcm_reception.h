#pragma once

#include <string>
#include <vector>

namespace framewatch::drivers {

/// From where messages of a udpm:// provider are taken; other providers do not need it.
struct LcmReception {
  std::vector<std::string> interfaces{"lo"};  ///< see MulticastGroup
  int receive_buffer_bytes = 4194304;
};

}  // namespace framewatch::drivers
