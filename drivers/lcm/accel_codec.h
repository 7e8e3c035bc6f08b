// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "estimator/motion/sample.h"

// Messages with accelerations: accel_t, and channel_table_t, which names its channels.
namespace framewatch::drivers {

/// A sample of one accelerometer node, as accel_t carries it.
struct SensorNodeSample {
  estimator::Time time;
  std::int64_t sequence = 0;
  std::int32_t node = 0;
  std::array<double, 3> accel_abs_mps2{};  ///< x, y, z; NaN without a valid value
};

/// Bytes of one encoded accel_t.
inline constexpr std::size_t kAccelBytes = 52;

/// Times beyond this, 285 years either way, are refused, so that arithmetic on times stays exact.
inline constexpr std::int64_t kLatestTime_us = std::int64_t{1} << 53;

/// Decodes an accel_t. Returns nullopt when its size or fingerprint is wrong or its time is beyond
/// kLatestTime_us.
std::optional<SensorNodeSample> decode_accel(const void* data, std::size_t size);
/// Returns the time stamp of an accel_t in microseconds. Returns nullopt when its size or
/// fingerprint is wrong.
std::optional<std::int64_t> accel_time_us(const void* data, std::size_t size);
/// Encodes a sample as accel_t.
std::vector<std::uint8_t> encode_accel(const SensorNodeSample& sample);

/// Names the nodes and axes of a stream of accel_t, as channel_table_t carries it.
struct ChannelTable {
  struct Entry {
    std::string name;
    std::int32_t node = 0;
    std::int32_t axis = 0;  ///< 0 x, 1 y, 2 z
    bool operator==(const Entry&) const = default;

    template <typename Archive>
    void archive(Archive& a) {
      a(name, node, axis);
    }
  };
  double rate_hz = 0;  ///< nominal, 0 when unknown
  std::vector<Entry> entries;
  bool operator==(const ChannelTable&) const = default;

  template <typename Archive>
  void archive(Archive& a) {
    a(rate_hz);
    entries.resize(a.count(entries.size()));
    for (Entry& entry : entries) a(entry);
  }
};

inline constexpr std::int32_t kMaxTableChannels = 65536;

/// Decodes a channel_table_t. Returns nullopt unless the bytes are exactly one, with at most
/// kMaxTableChannels channels.
std::optional<ChannelTable> decode_channel_table(const void* data, std::size_t size);

/// Returns "ACCEL" for the channel "ACCEL_CHANNELS", and an empty text for a channel without
/// tables.
std::string stream_of_table(const std::string& channel);

/// The address at which the samples of one named channel are sent.
struct AxisAddress {
  std::string lcm_channel = "ACCEL";
  std::int32_t node = 0;
  int axis = 0;  ///< 0 x, 1 y, 2 z
};

/// An encoded message and its LCM channel.
struct Message {
  std::string channel;
  std::vector<std::uint8_t> bytes;
};

/// Turns instants of many channels into the accel_t messages of their nodes, with running sequence
/// numbers, and into the channel_table_t that names them.
class AccelMessages {
 public:
  /// `names` and `addresses` are parallel. No two channels may share an address.
  AccelMessages(std::vector<std::string> names, std::vector<AxisAddress> addresses, double rate_hz);

  /// Returns one message per node in the order of their first channels. `values` are in channel
  /// order, NaN for a lost one. A node without a finite value has no message, though its sequence
  /// number advances: the receiver sees a loss.
  std::vector<Message> samples(std::int64_t time_us, const std::vector<double>& values);
  /// Returns one channel_table_t per LCM channel.
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
