#pragma once

#include <cstdint>
#include <string>

namespace framewatch::drivers {

/// Bytes that a compressed file of `packed_bytes` may unpack to: 4 GiB, but no more than 4,000
/// times its own size or 64 MiB, whichever is more; or what set_unpack_limit() said.
std::int64_t unpack_limit(std::int64_t packed_bytes);

/// From now on, in the whole process, whatever the size of the compressed file (--max-size).
void set_unpack_limit(std::int64_t bytes);

/// "unpacks to more than 64 MiB, from 250 KiB; ...", for messages.
std::string over_unpack_limit(std::int64_t packed_bytes);

}  // namespace framewatch::drivers
