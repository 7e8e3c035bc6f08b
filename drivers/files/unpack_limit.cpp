#include "drivers/files/unpack_limit.h"

#include <algorithm>
#include <atomic>

#include <fmt/core.h>

#include "drivers/files/input_file.h"

namespace framewatch::drivers {
namespace {

// A raw log of `run` has at most 4,000 MB (history.rotate_mb), and one of channels that are all
// dead packs to a 3,400th, measured; what a person made packs to a 32,000th.
constexpr std::int64_t kMaxBytes = std::int64_t{4} << 30;
constexpr std::int64_t kMaxTimes = 4000;
constexpr std::int64_t kAlwaysBytes = std::int64_t{64} << 20;

std::atomic<std::int64_t> asked_bytes{0};

}  // namespace

std::int64_t unpack_limit(std::int64_t packed_bytes) {
  if (const std::int64_t asked = asked_bytes; asked > 0) return asked;
  return std::min(kMaxBytes, std::max(kAlwaysBytes, kMaxTimes * std::min(packed_bytes, kMaxBytes)));
}

void set_unpack_limit(std::int64_t bytes) {
  asked_bytes = bytes;
}

std::string over_unpack_limit(std::int64_t packed_bytes) {
  return fmt::format("unpacks to more than {}, from {}; --max-size allows more",
                     size_text(unpack_limit(packed_bytes)), size_text(packed_bytes));
}

}  // namespace framewatch::drivers
