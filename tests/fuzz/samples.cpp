// SPDX-License-Identifier: MIT
// Messages in sequence, as `framewatch run` receives them, to the end of an estimation. The
// messages that it publishes must be valid.
#include <cmath>

#include "daemon/monitor/estimation/estimation.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/message_check.h"
#include "tests/fuzz/example_building.h"
#include "tests/fuzz/message_sequence.h"
#include "tests/fuzz/shaken.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

const std::vector<std::string> kSampleChannels{"ACCEL", "ACCEL_CHANNELS", "TEMPERATURE", "COUNTS",
                                               "OTHER"};

constexpr int kMaxInstants = 128;  ///< before and after the messages; a window has 50

void estimate_messages(Bytes input) {
  Pieces pieces(input);
  daemon::Estimation estimation(
      example_building(), [](std::int64_t, const std::string& channel, const auto& bytes) {
        const char* type = drivers::type_of_lcm_channel(channel);
        require(type != nullptr &&
                    drivers::known_type(*drivers::fingerprint(bytes)) == std::string_view(type),
                "a message of the channel's type");
      });
  ShakenNodes nodes;
  const int before = pieces.take<std::uint8_t>() % kMaxInstants;
  const int after = pieces.take<std::uint8_t>() % kMaxInstants;
  nodes.shake(before, [&](const auto& bytes) {
    (void)estimation.message("ACCEL", bytes.data(), bytes.size());
  });
  take_messages(pieces, kSampleChannels, [&](const std::string& channel, const auto& payload) {
    (void)estimation.message(channel, payload.data(), payload.size());
  });
  nodes.shake(after, [&](const auto& bytes) {
    (void)estimation.message("ACCEL", bytes.data(), bytes.size());
  });
  estimation.finish();
}

std::vector<std::string> sample_seeds() {
  std::vector<std::string> out;
  for (const int shaken : {0, 30, kMaxInstants - 1}) {
    PiecesWriter seed;
    seed.put(static_cast<std::uint8_t>(shaken)).put(static_cast<std::uint8_t>(shaken));
    const std::string messages = message_sequence(kSampleChannels, example_messages());
    out.push_back(seed.text() + messages);
  }
  return out;
}

}  // namespace

const FuzzTarget kSamplesTarget{"samples", &estimate_messages, &sample_seeds};

}  // namespace framewatch::test
