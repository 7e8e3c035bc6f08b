// SPDX-License-Identifier: MIT
#include "drivers/can/can_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace framewatch::drivers {

CanEncoder::CanEncoder(const CanMap& map) : map_(map), block_(map.nodes.size()) {
  for (std::size_t n = 0; n < map.nodes.size(); ++n) order_.push_back(n);
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
    return map.nodes[a].messages.front().id < map.nodes[b].messages.front().id;
  });
}

std::vector<BusFrame> CanEncoder::instant(const std::vector<double>& values) {
  std::vector<BusFrame> out;
  for (int b = 0; b < static_cast<int>(map_.buses.size()); ++b)
    if (map_.has_sync(b))
      out.push_back({b, sync_frame(map_.buses[static_cast<std::size_t>(b)], instant_)});
  for (const std::size_t n : order_) add_node(n, values, out);
  ++instant_;
  return out;
}

void CanEncoder::add_node(std::size_t index, const std::vector<double>& values,
                          std::vector<BusFrame>& out) {
  const CanNodeMap& node = map_.nodes[index];
  const int phase = static_cast<int>(instant_ % node.samples_per_frame);
  std::vector<double>& block = block_[index];
  if (phase == 0) block.clear();
  for (const double v : values) block.push_back(v);
  if (phase + 1 < node.samples_per_frame) return;
  const std::int64_t count = instant_ / node.samples_per_frame;
  for (const CanMessageMap& m : node.messages) {
    BusFrame made{node.bus, {}};
    CanFrame& frame = made.frame;
    frame.id = m.id;
    frame.extended = m.extended;
    frame.fd = m.fd;
    frame.bit_rate_switch = m.fd;
    frame.length = static_cast<std::uint8_t>(m.length);
    for (const CanSwitch& multiplexor : m.switches)
      put_bits(multiplexor.field, multiplexor.values.front().least, frame.data);
    if (m.counter) put_bits(*m.counter, static_cast<std::uint64_t>(count), frame.data);
    if (m.clock) {
      const double ticks = static_cast<double>(instant_ - phase) * node.period_us /
                           node.clock_unit_us / m.clock->factor;
      if (m.clock->value == CanValue::integer)
        put_bits(*m.clock, static_cast<std::uint64_t>(std::llround(ticks)), frame.data);
      else
        put_physical(*m.clock, ticks * m.clock->factor, frame.data);
    }
    bool whole = true;
    for (const CanReading& r : m.readings) {
      const double value = block[static_cast<std::size_t>(r.sample) * values.size() +
                                 static_cast<std::size_t>(r.axis)];
      whole = whole && std::isfinite(value);
      put_physical(r.field, value, frame.data);
    }
    if (whole) out.push_back(made);
  }
}

}  // namespace framewatch::drivers
