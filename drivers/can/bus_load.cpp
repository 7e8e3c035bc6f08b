// SPDX-License-Identifier: MIT
#include "drivers/can/bus_load.h"

namespace framewatch::drivers {
namespace {

constexpr int kInterframe = 3;
/// ACK, its delimiter, end of frame: never stuffed.
constexpr int kTail = 1 + 1 + 7 + kInterframe;

double fd_frame_s(int bytes, bool extended, double bit_rate, double data_bit_rate) {
  // SOF, id, RRS, IDE, FDF, res, BRS; a 29-bit id has SRR and 18 bits more. Stuffed.
  const int head = extended ? 1 + 11 + 1 + 1 + 18 + 1 + 1 + 1 + 1 : 1 + 11 + 1 + 1 + 1 + 1 + 1;
  const int head_bits = head + (head - 1) / 4;
  // ESI, DLC, data: stuffed. Stuff count and CRC have a fixed stuff bit before every four.
  const int body = 1 + 4 + 8 * bytes;
  const int check = 4 + (bytes > 16 ? 21 : 17);
  const int body_bits = body + body / 4 + check + (check + 3) / 4;
  return (head_bits + 1 + kTail) / bit_rate + body_bits / data_bit_rate;
}

}  // namespace

int worst_classical_bits(int bytes, bool extended) {
  const int stuffed = (extended ? 54 : 34) + 8 * bytes;
  return (extended ? 64 : 44) + 8 * bytes + (stuffed - 1) / 4 + kInterframe;
}

double worst_frame_s(int bytes, bool extended, bool fd, int bit_rate, int data_bit_rate) {
  return fd ? fd_frame_s(bytes, extended, bit_rate, data_bit_rate)
            : worst_classical_bits(bytes, extended) / static_cast<double>(bit_rate);
}

BusLoad bus_load(const CanMap& map, int index) {
  const CanBusMap& bus = map.buses[static_cast<std::size_t>(index)];
  BusLoad load;
  const auto add = [&](double frames_hz, int bytes, bool extended, bool fd) {
    load.frames_hz += frames_hz;
    load.share += frames_hz * worst_frame_s(bytes, extended, fd, bus.bit_rate, bus.data_bit_rate);
  };
  for (const CanNodeMap& node : map.nodes) {
    if (node.bus != index) continue;
    for (const CanMessageMap& m : node.messages)
      add(1e6 / (node.period_us * node.samples_per_frame), m.length, m.extended, m.fd);
  }
  if (map.has_sync(index)) add(1e6 / bus.sync_period_us, 0, false, false);
  return load;
}

}  // namespace framewatch::drivers
