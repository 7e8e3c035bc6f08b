#include "daemon/base/random_id.h"

#include <random>

namespace framewatch::daemon {

std::int64_t random_id() {
  std::random_device source;
  return 1 + (std::int64_t{source()} << 20 | std::int64_t{source() >> 12});
}

}  // namespace framewatch::daemon
