#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace framewatch::drivers {

/// Which node and axis of a stream of accel_t carries which named channel, as channel_table_t says.
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

/// Empty unless the bytes are exactly one channel_table_t, of at most kMaxTableChannels channels.
std::optional<ChannelTable> decode_channel_table(const void* data, std::size_t size);

/// "ACCEL" for "ACCEL_CHANNELS"; empty when `channel` names no table.
std::string stream_of_table(const std::string& channel);

}  // namespace framewatch::drivers
