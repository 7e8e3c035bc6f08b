#pragma once

#include <cstdint>

namespace framewatch::drivers {

/// Bytes that this process has read from its input files so far, compressed ones as they are on the
/// disk. For progress; any thread may ask.
std::int64_t bytes_read();

/// Of readers.
void count_bytes_read(std::int64_t bytes);

}  // namespace framewatch::drivers
