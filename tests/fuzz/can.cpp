// SPDX-License-Identifier: MIT
// CAN frames one after the other, with the times at which they were received.
#include <cmath>
#include <utility>

#include "drivers/can/can_encoder.h"
#include "drivers/can/can_intake.h"
#include "tests/fuzz/example_building.h"
#include "tests/fuzz/targets.h"

namespace framewatch::test {
namespace {

using drivers::CanFrame;

struct CanExample {
  daemon::Config config;
  std::vector<drivers::BusFrame> traffic;  ///< of some instants
  std::vector<std::pair<std::uint32_t, bool>> ids;
};

constexpr int kInstants = 24;  // some nodes send several in one frame

CanExample can_example(const char* name) {
  const std::string path = std::string("configs/can/") + name + ".toml";
  CanExample out{valid_config(FRAMEWATCH_SOURCE_DIR "/" + path, repository_file(path)), {}, {}};
  drivers::CanEncoder encoder(out.config.can);
  for (int i = 0; i < kInstants; ++i)
    for (drivers::BusFrame& f :
         encoder.instant(std::vector<double>(out.config.pipeline.axes.size(), 0.1 * i))) {
      out.ids.emplace_back(f.frame.id, f.frame.extended);
      f.frame.stamp_us = 10'000 * i + 100 * std::int64_t(out.traffic.size() % 64);
      out.traffic.push_back(f);
    }
  require(!out.ids.empty(), "traffic");
  return out;
}

/// One configuration for each kind of timing: SYNC, clocks, counters, CAN FD, 29-bit ids, several
/// buses.
const std::vector<CanExample>& can_examples() {
  static const std::vector<CanExample> examples = [] {
    std::vector<CanExample> out;
    for (const char* name : {"raw_int16", "bosch_mm510", "epson_m_a552", "fd_block", "j1939_61485",
                             "sbg_ellipse", "xsens_mti600"})
      out.push_back(can_example(name));
    return out;
  }();
  return examples;
}

/// The contents of a frame.
enum : std::uint8_t {
  kKnownId = 1,  ///< taken from a frame of the traffic
  kExtended = 2,
  kRemote = 4,
  kError = 8,
  kFd = 16,
  kLeap = 32,  ///< arbitrary, or a little after the one before
};

CanFrame take_frame(Pieces& input, const CanExample& example, std::int64_t& now_us) {
  CanFrame frame;
  const auto what = input.take<std::uint8_t>();
  frame.extended = what & kExtended;
  frame.remote = what & kRemote;
  frame.error = what & kError;
  frame.fd = what & kFd;
  if (what & kKnownId) {
    const auto& [id, extended] = example.ids[input.take<std::uint8_t>() % example.ids.size()];
    frame.id = id;
    frame.extended = extended;
  } else {
    frame.id = input.take<std::uint32_t>() & (frame.extended ? 0x1fffffff : 0x7ff);
  }
  const auto later_us = input.take<std::int16_t>();
  // A kernel's clock is never wrong by more than some hundred thousand years.
  now_us = what & kLeap ? input.take<std::int64_t>() / 4 : now_us + later_us;
  frame.stamp_us = now_us;
  frame.length = static_cast<std::uint8_t>(input.take<std::uint8_t>() % (frame.fd ? 65 : 9));
  while (!drivers::is_fd_length(frame.length)) --frame.length;
  const Bytes data = input.take_bytes(frame.length);
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

void take_frames(Bytes input) {
  Pieces pieces(input);
  const CanExample& example = can_examples()[pieces.take<std::uint8_t>() % can_examples().size()];
  const drivers::CanMap& map = example.config.can;
  drivers::CanIntake intake(map, [&](const estimator::AccelSample& sample) {
    require(sample.axis >= 0 && std::size_t(sample.axis) < example.config.pipeline.axes.size(),
            "an axis of the building");
  });
  std::int64_t now_us = 1'700'000'000'000'000;
  for (int k = pieces.take<std::uint8_t>() % 4; k > 0; --k)
    for (const drivers::BusFrame& f : example.traffic) {
      CanFrame frame = f.frame;
      frame.stamp_us += now_us - 10'000 * kInstants * k;
      intake.frame(f.bus, frame);
    }
  while (!pieces.empty()) {
    const int bus = pieces.take<std::uint8_t>() % static_cast<int>(map.buses.size());
    intake.frame(bus, take_frame(pieces, example, now_us));
  }
  intake.finish();
  for (std::size_t node = 0; node < map.nodes.size(); ++node) (void)intake.node(node);
}

std::vector<std::string> can_seeds() {
  std::vector<std::string> out;
  for (std::size_t e = 0; e < can_examples().size(); ++e) {
    PiecesWriter seed;
    seed.put(static_cast<std::uint8_t>(e)).put(std::uint8_t{1});
    std::int64_t before_us = 0;
    for (const drivers::BusFrame& f : can_examples()[e].traffic) {
      seed.put(static_cast<std::uint8_t>(f.bus))
          .put(static_cast<std::uint8_t>((f.frame.extended ? kExtended : 0) |
                                         (f.frame.fd ? kFd : 0)))
          .put(f.frame.id)
          .put(static_cast<std::int16_t>(f.frame.stamp_us - before_us))
          .put(f.frame.length)
          .put_bytes(Bytes(f.frame.data).first(f.frame.length));
      before_us = f.frame.stamp_us;
    }
    out.push_back(seed.text());
  }
  return out;
}

}  // namespace

const FuzzTarget kCanTarget{"can", &take_frames, &can_seeds};

}  // namespace framewatch::test
