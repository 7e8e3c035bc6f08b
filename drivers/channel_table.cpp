#include "drivers/channel_table.h"

#include <string_view>

#include <framewatch/channel_table_t.hpp>

namespace framewatch::drivers {
namespace {

constexpr std::string_view kSuffix = "_CHANNELS";
constexpr std::size_t kFixedBytes = 8 + 8 + 8 + 4;  // fingerprint, time, rate, channels

std::uint32_t big_endian_32(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
         std::uint32_t{bytes[2]} << 8 | std::uint32_t{bytes[3]};
}

bool lengths_fit(const std::uint8_t* bytes, std::size_t size) {
  if (size < kFixedBytes) return false;
  const std::uint32_t channels = big_endian_32(bytes + kFixedBytes - 4);
  if (channels > static_cast<std::uint32_t>(kMaxTableChannels)) return false;
  std::size_t offset = kFixedBytes;
  for (std::uint32_t i = 0; i < channels; ++i) {
    if (size - offset < 4) return false;
    const std::size_t length = big_endian_32(bytes + offset);  // with the closing zero
    offset += 4;
    if (length < 1 || length > size - offset || bytes[offset + length - 1] != 0) return false;
    offset += length;
  }
  return size - offset == std::size_t{8} * channels;
}

}  // namespace

std::optional<ChannelTable> decode_channel_table(const void* data, std::size_t size) {
  if (!lengths_fit(static_cast<const std::uint8_t*>(data), size)) return std::nullopt;
  channel_table_t message{};
  if (message.decode(data, 0, static_cast<int>(size)) != static_cast<int>(size))
    return std::nullopt;
  ChannelTable table;
  table.rate_hz = message.rate_hz;
  for (std::size_t i = 0; i < message.name.size(); ++i)
    table.entries.push_back({message.name[i], message.node[i], message.axis[i]});
  return table;
}

std::string stream_of_table(const std::string& channel) {
  if (!std::string_view(channel).ends_with(kSuffix)) return {};
  return channel.substr(0, channel.size() - kSuffix.size());
}

}  // namespace framewatch::drivers
