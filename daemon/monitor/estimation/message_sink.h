#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace framewatch::daemon {

/// Where encoded messages go: LCM or a log. `time_us` is sensor time.
using MessageSink = std::function<void(std::int64_t time_us, const std::string& channel,
                                       const std::vector<std::uint8_t>& bytes)>;

}  // namespace framewatch::daemon
