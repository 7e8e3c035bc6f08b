#include "drivers/files/bytes_read.h"

#include <atomic>

namespace framewatch::drivers {
namespace {

std::atomic<std::int64_t> bytes{0};

}  // namespace

std::int64_t bytes_read() {
  return bytes.load(std::memory_order_relaxed);
}

void count_bytes_read(std::int64_t more) {
  bytes.fetch_add(more, std::memory_order_relaxed);
}

}  // namespace framewatch::drivers
