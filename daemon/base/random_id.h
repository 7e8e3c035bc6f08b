#pragma once

#include <cstdint>

namespace framewatch::daemon {

/// 1 to 2^52, by chance: who asks over LCM knows the answer by it.
std::int64_t random_id();

}  // namespace framewatch::daemon
