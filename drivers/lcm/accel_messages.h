#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/lcm/accel_codec.h"

namespace framewatch::drivers {

/// Where the samples of one named channel travel.
struct AxisAddress {
  std::string lcm_channel = "ACCEL";
  std::int32_t node = 0;
  int axis = 0;  ///< 0 x, 1 y, 2 z
};

struct Message {
  std::string channel;
  std::vector<std::uint8_t> bytes;
};

/// Turns instants of many channels into the accel_t messages of their nodes, with running sequence
/// numbers, and the channel_table_t that names them.
class AccelMessages {
 public:
  /// Parallel vectors. No two channels may share an address.
  AccelMessages(std::vector<std::string> names, std::vector<AxisAddress> addresses, double rate_hz);

  /// One message per node, in the order in which the nodes first appear; none for a node without a
  /// finite value, though its sequence goes on: a loss. `values` in channel order, NaN where lost.
  std::vector<Message> samples(std::int64_t time_us, const std::vector<double>& values);
  /// One channel_table_t per LCM channel.
  std::vector<Message> tables(std::int64_t time_us) const;

 private:
  struct Node {
    std::string lcm_channel;
    std::int32_t node;
    std::vector<std::size_t> channels;
    std::int64_t sequence = 0;
  };

  std::vector<std::string> names_;
  std::vector<AxisAddress> addresses_;
  double rate_hz_;
  std::vector<Node> nodes_;
};

}  // namespace framewatch::drivers
