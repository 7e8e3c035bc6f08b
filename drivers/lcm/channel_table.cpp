#include "drivers/lcm/channel_table.h"

#include <string_view>

#include <framewatch/channel_table_t.hpp>

#include "drivers/lcm/message_check.h"

namespace framewatch::drivers {
namespace {

constexpr std::string_view kSuffix = "_CHANNELS";

}  // namespace

std::optional<ChannelTable> decode_channel_table(const void* data, std::size_t size) {
  const auto message = decoded<channel_table_t>({static_cast<const std::uint8_t*>(data), size});
  if (!message || message->channels > kMaxTableChannels) return std::nullopt;
  ChannelTable table;
  table.rate_hz = message->rate_hz;
  for (std::size_t i = 0; i < message->name.size(); ++i)
    table.entries.push_back({message->name[i], message->node[i], message->axis[i]});
  return table;
}

std::string stream_of_table(const std::string& channel) {
  if (!std::string_view(channel).ends_with(kSuffix)) return {};
  return channel.substr(0, channel.size() - kSuffix.size());
}

}  // namespace framewatch::drivers
