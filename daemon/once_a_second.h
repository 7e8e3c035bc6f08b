#pragma once

#include <cstdint>

#include "daemon/clocks.h"

namespace framewatch::daemon {

/// What is due once a second of the host's clock, and again at once when that clock stepped back.
class OnceASecond {
 public:
  bool due(std::int64_t now_us) {
    if (now_us < next_us_ && next_us_ <= now_us + kSecond_us) return false;
    next_us_ = now_us + kSecond_us;
    return true;
  }

 private:
  std::int64_t next_us_ = INT64_MIN;
};

}  // namespace framewatch::daemon
