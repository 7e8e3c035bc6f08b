// SPDX-License-Identifier: MIT
#include "drivers/can/can_source.h"

#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include <fmt/core.h>

namespace framewatch::drivers {
namespace {

constexpr std::int64_t kPollAgain_us = 50'000;
constexpr int kBatches = 64;  ///< read from one bus before the others have their turn
constexpr std::uint8_t kNmtStart = 1;

int make_timer(double period_us) {
  const int timer = ::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  const auto ns = static_cast<std::int64_t>(1000 * period_us);
  itimerspec every{};
  every.it_interval.tv_sec = ns / 1'000'000'000;
  every.it_interval.tv_nsec = ns % 1'000'000'000;
  every.it_value = every.it_interval;
  ::timerfd_settime(timer, 0, &every, nullptr);
  return timer;
}

}  // namespace

void ContinuousStamps::now(const HostClockReading& reading) {
  // A doubtful reading would look like a step, and the next one like a step back.
  if (started_ && reading.doubtful_us > kStep_us / 4) return;
  const std::int64_t change_us = reading.offset_us - offset_us_;
  const bool step = started_ && std::abs(change_us) >= kStep_us;
  started_ = true;
  offset_us_ = reading.offset_us;
  if (step) {
    before_us_ = total_us_;
    total_us_ += change_us;
    ++steps_;
  }
  newest_us_ = reading.day_us - total_us_;
}

std::int64_t ContinuousStamps::continuous(std::int64_t stamp_us) {
  const std::int64_t after = stamp_us - total_us_, before = stamp_us - before_us_;
  const std::int64_t oldest = std::max(last_us_, drained_us_) - kStep_us;
  const auto possible = [&](std::int64_t us) {
    return us >= oldest && us <= newest_us_ + kStep_us;
  };
  const bool nearer = std::abs(before - last_us_) < std::abs(after - last_us_);
  const bool earlier =
      steps_ > 0 && (possible(before) == possible(after) ? nearer : possible(before));
  last_us_ = earlier ? before : after;
  return last_us_;
}

HostClockReading read_host_clock() {
  constexpr int kTries = 20;
  constexpr std::int64_t kClose_us = 20;
  const auto read = [](clockid_t clock) {
    timespec time{};
    ::clock_gettime(clock, &time);
    return 1'000'000 * std::int64_t{time.tv_sec} + time.tv_nsec / 1000;
  };
  // An interruption of the process between two readings must not look like a step.
  HostClockReading closest{0, 0, INT64_MAX};
  for (int i = 0; i < kTries && closest.doubtful_us > kClose_us; ++i) {
    const std::int64_t before = read(CLOCK_MONOTONIC), day = read(CLOCK_REALTIME);
    const std::int64_t apart = read(CLOCK_MONOTONIC) - before;
    if (apart < closest.doubtful_us) closest = {day, day - before - apart / 2, apart};
  }
  return closest;
}

std::vector<CanFilter> filters_of(const CanMap& map, int bus) {
  std::vector<CanFilter> out;
  for (const CanNodeMap& node : map.nodes) {
    if (node.bus != bus) continue;
    for (const CanMessageMap& m : node.messages) out.push_back({m.id, m.mask, m.extended});
    if (node.canopen_id == 0) continue;
    out.push_back({0x080u + static_cast<std::uint32_t>(node.canopen_id), 0x7FF, false});
    out.push_back({0x700u + static_cast<std::uint32_t>(node.canopen_id), 0x7FF, false});
  }
  for (const CanValueMap& v : map.values)
    if (v.bus == bus) out.push_back({v.message.id, v.message.mask, v.message.extended});
  if (map.has_sync(bus))
    out.push_back({map.buses[static_cast<std::size_t>(bus)].sync_id, 0x7FF, false});
  if (map.buses[static_cast<std::size_t>(bus)].nmt_start) out.push_back({0x700, 0x780, false});
  return out;
}

CanSource::CanSource(const CanMap& map, bool everything, Handler handler)
    : map_(map), everything_(everything), handler_(std::move(handler)), buses_(map.buses.size()) {
  for (std::size_t b = 0; b < buses_.size(); ++b)
    if (map.buses[b].send_sync && map.has_sync(static_cast<int>(b)))
      buses_[b].timer.reset(make_timer(map.buses[b].sync_period_us));
  for (Bus& bus : buses_) bus.stamps.now(read_host_clock());
}

bool CanSource::open_bus(std::size_t b, std::string& error) {
  const CanBusMap& settings = map_.buses[b];
  const auto filters =
      everything_ ? std::vector<CanFilter>{} : filters_of(map_, static_cast<int>(b));
  return buses_[b].socket.open(settings.interface, settings.receive_buffer_bytes, filters,
                               settings.send_sync, error);
}

std::vector<std::string> CanSource::open() {
  std::vector<std::string> notes;
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    if (buses_[b].attached) continue;
    const CanBusMap& settings = map_.buses[b];
    std::string error;
    poll_interface(b, 0);
    const Bus& bus = buses_[b];
    if (!bus.socket.is_open()) {
      (void)open_bus(b, error);
      notes.push_back(error + "; waiting for it");
    } else if (!bus.state.open) {
      notes.push_back(settings.interface + ": the interface is down; waiting for it");
    }
    if (bus.socket.is_open() && bus.socket.receive_buffer_bytes() < settings.receive_buffer_bytes)
      notes.push_back(fmt::format(
          "{}: the kernel grants {} of {} bytes of receive buffer: raise net.core.rmem_max "
          "(deploy/can)",
          settings.interface, bus.socket.receive_buffer_bytes(), settings.receive_buffer_bytes));
  }
  return notes;
}

void CanSource::attach(int bus, int descriptor) {
  Bus& b = buses_[static_cast<std::size_t>(bus)];
  b.socket = CanSocket(descriptor);
  b.attached = true;
  b.state.open = true;
}

void CanSource::descriptors(std::vector<pollfd>& out) const {
  for (const Bus& bus : buses_) {
    if (bus.socket.is_open()) out.push_back({bus.socket.descriptor(), POLLIN, 0});
    if (bus.timer.get() >= 0) out.push_back({bus.timer.get(), POLLIN, 0});
  }
}

void CanSource::lose(Bus& bus) {
  if (bus.state.open) ++bus.state.downs;
  bus.state.open = false;
}

/// Notices an interface that came, went, or was replaced by another one of the same name.
void CanSource::poll_interface(std::size_t b, std::int64_t now_us) {
  Bus& bus = buses_[b];
  if (bus.attached || now_us < bus.poll_again_us) return;
  bus.poll_again_us = now_us + kPollAgain_us;
  bool up = false;
  const int index = find_interface(map_.buses[b].interface, up);
  if (bus.socket.is_open() && index != bus.socket.interface_index()) {
    bus.dropped_before += bus.socket.dropped();
    bus.socket = CanSocket();
    lose(bus);
  }
  std::string error;
  if (!bus.socket.is_open() && (index == 0 || !open_bus(b, error))) return;
  if (!up) return lose(bus);
  if (bus.state.open) return;
  bus.state.open = true;
  if (map_.buses[b].nmt_start) start_node(bus, 0);
}

void CanSource::start_node(const Bus& bus, std::uint8_t node) const {
  CanFrame start;
  start.length = 2;
  start.data = {kNmtStart, node};
  (void)bus.socket.write(start);
}

void CanSource::send_sync(std::size_t b) {
  std::uint64_t due = 0;
  if (::read(buses_[b].timer.get(), &due, sizeof due) != sizeof due || due == 0) return;
  if (!buses_[b].state.open) return;
  (void)buses_[b].socket.write(sync_frame(map_.buses[b], buses_[b].syncs++));
}

void CanSource::read(std::size_t b) {
  Bus& bus = buses_[b];
  bus.stamps.now(read_host_clock());
  for (int i = 0; i < kBatches && bus.socket.is_open(); ++i) {
    switch (bus.socket.read(batch_)) {
      case CanSocket::Read::frames:
        bus.stamps.now(read_host_clock());
        break;
      case CanSocket::Read::idle:
        return bus.stamps.drained();
      case CanSocket::Read::down:
        bus.poll_again_us = 0;
        return lose(bus);
      case CanSocket::Read::failed:
        bus.dropped_before += bus.socket.dropped();
        bus.socket = CanSocket();
        bus.poll_again_us = 0;
        return lose(bus);
    }
    for (CanFrame& frame : batch_) {
      frame.stamp_us = bus.stamps.continuous(frame.stamp_us);
      const bool boot_up = !frame.extended && !frame.error && (frame.id & 0x780u) == 0x700u &&
                           frame.length == 1 && frame.data[0] == 0;
      if (boot_up && map_.buses[b].nmt_start)
        start_node(bus, static_cast<std::uint8_t>(frame.id & 0x7Fu));
      handler_(static_cast<int>(b), frame);
    }
  }
}

void CanSource::handle(std::int64_t now_us) {
  for (std::size_t b = 0; b < buses_.size(); ++b) {
    poll_interface(b, now_us);
    if (buses_[b].timer.get() >= 0) send_sync(b);
    if (buses_[b].socket.is_open()) read(b);
  }
}

std::int64_t CanSource::clock_steps() const {
  std::int64_t most = 0;
  for (const Bus& bus : buses_) most = std::max(most, bus.stamps.steps());
  return most;
}

std::int64_t CanSource::dropped() const {
  std::int64_t sum = 0;
  for (const Bus& bus : buses_) sum += bus.dropped_before + bus.socket.dropped();
  return sum;
}

}  // namespace framewatch::drivers
