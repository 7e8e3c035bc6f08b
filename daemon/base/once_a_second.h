#pragma once

#include <cstdint>

#include "daemon/base/clocks.h"

namespace framewatch::daemon {

/// Says when something that is done once a second is due, by the host's clock; at once when that
/// clock was set back.
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
