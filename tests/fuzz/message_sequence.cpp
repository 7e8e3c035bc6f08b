// SPDX-License-Identifier: MIT
#include "tests/fuzz/message_sequence.h"

#include <algorithm>
#include <cstring>

#include <framewatch/message_layouts.hpp>

#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"
#include "tests/drivers/lcm/example_messages.h"

namespace framewatch::test {
namespace {

constexpr std::size_t kFingerprintBytes = 8;

std::vector<std::uint8_t> fingerprint_of(const std::string& channel) {
  const char* type = drivers::type_of_lcm_channel(channel);
  std::vector<std::uint8_t> out;
  for (const drivers::MessageLayout& layout : drivers::kMessageLayouts) {
    if (!type || std::strcmp(type, layout.type) != 0) continue;
    const auto fingerprint = static_cast<std::uint64_t>(layout.fingerprint());
    for (int bit = 56; bit >= 0; bit -= 8)
      out.push_back(static_cast<std::uint8_t>(fingerprint >> bit));
  }
  return out;
}

}  // namespace

void take_messages(Pieces& input, const std::vector<std::string>& channels,
                   const std::function<void(const std::string& channel,
                                            const std::vector<std::uint8_t>& payload)>& take) {
  while (!input.empty()) {
    const std::string& channel = channels[input.take<std::uint8_t>() % channels.size()];
    std::vector<std::uint8_t> payload = fingerprint_of(channel);
    const Bytes body = input.take_block();
    payload.insert(payload.end(), body.begin(), body.end());
    take(channel, payload);
  }
}

std::string message_sequence(
    const std::vector<std::string>& channels,
    const std::vector<std::pair<std::string, std::vector<std::uint8_t>>>& messages) {
  PiecesWriter out;
  for (const auto& [channel, payload] : messages) {
    const auto at = std::find(channels.begin(), channels.end(), channel);
    if (at != channels.end())
      out.put(static_cast<std::uint8_t>(at - channels.begin()))
          .put_block(Bytes(payload).subspan(kFingerprintBytes));
  }
  return out.text();
}

std::vector<std::pair<std::string, std::vector<std::uint8_t>>> example_messages() {
  std::vector<std::pair<std::string, std::vector<std::uint8_t>>> out;
  drivers::examples::for_each([&](const char* channel, const auto& message) {
    out.emplace_back(channel, drivers::encoded(message));
  });
  return out;
}

}  // namespace framewatch::test
