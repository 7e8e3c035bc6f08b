#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "fleet/store/fleet_store.h"

namespace framewatch::fleet {

/// What a building may say in an hour: more than an uplink ever does that catches up (4 older
/// summaries a second) or sends raw samples (2000 kbit/s). What is beyond is flooding: counted and
/// not stored.
class FloodGate {
 public:
  static constexpr std::int64_t kMessages = 20'000, kBytes = 1'000'000'000;

  explicit FloodGate(std::int64_t most_messages = kMessages, std::int64_t most_bytes = kBytes)
      : most_messages_(most_messages), most_bytes_(most_bytes) {}

  /// Whether a message of `bytes` is within the hour of `hub_us` (UTC).
  bool takes(const std::string& building, std::size_t bytes, std::int64_t hub_us);
  /// What did not pass since the last call.
  std::vector<ReceivedFlood> take_floods();

 private:
  struct Said {
    std::int64_t messages = 0, bytes = 0;  ///< in this hour
    std::int64_t flood_messages = 0, flood_bytes = 0;
  };
  std::int64_t most_messages_, most_bytes_;
  std::int64_t hour_us_ = 0;
  std::map<std::string, Said> said_;
  std::vector<ReceivedFlood> floods_;  ///< of an hour that is over
};

}  // namespace framewatch::fleet
