// SPDX-License-Identifier: MIT
#pragma once

#include <poll.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "drivers/can/can_map.h"
#include "drivers/can/can_socket.h"

namespace framewatch::drivers {

/// A reading of the realtime clock together with the monotonic one.
struct HostClockReading {
  std::int64_t day_us = 0;
  std::int64_t offset_us = 0;    ///< realtime minus monotonic
  std::int64_t doubtful_us = 0;  ///< largest error of `offset_us`
};
/// Reads both clocks, several times if the process is interrupted between them.
HostClockReading read_host_clock();

/// Removes the steps of the host's clock from the receive stamps of one bus, so that stamps
/// continue the clock at the start. Pure: the caller reads the clock. Call now() after frames were
/// received and before continuous() gets their stamps.
class ContinuousStamps {
 public:
  /// Takes a reading of the clock and notices a step of 20 ms or more.
  void now(const HostClockReading& reading);
  /// Notes that no frame was waiting after the last reading.
  void drained() { drained_us_ = newest_us_; }
  /// Returns the stamp without the steps of the clock. The frame may have come before a step that
  /// was noticed only now, so two offsets are possible. Chooses the one that puts the frame after
  /// the last drained() and not into the future; if both do, the one nearer to the last stamp.
  std::int64_t continuous(std::int64_t stamp_us);
  std::int64_t steps() const { return steps_; }

 private:
  static constexpr std::int64_t kStep_us = 20'000;  ///< smaller changes are slewing

  bool started_ = false;
  std::int64_t offset_us_ = 0;  ///< from the last reading
  std::int64_t total_us_ = 0;   ///< sum of the steps so far
  std::int64_t before_us_ = 0;  ///< sum without the last step
  std::int64_t newest_us_ = 0;  ///< the last reading, continuous
  std::int64_t drained_us_ = 0;
  std::int64_t last_us_ = 0;  ///< last result of continuous()
  std::int64_t steps_ = 0;
};

/// Reads every bus of a map and reopens interfaces that come back. With `nmt_start` and `send_sync`
/// it also starts the CANopen nodes and sends their SYNC. Call open(), then wait for descriptors()
/// and call handle() in a loop.
class CanSource {
 public:
  using Handler = std::function<void(int bus, const CanFrame& frame)>;

  /// `map` must outlive this object. `everything` sets no filters, for a recorder. `handler` gets
  /// the frames with the index of their bus.
  CanSource(const CanMap& map, bool everything, Handler handler);
  CanSource(const CanSource&) = delete;
  CanSource& operator=(const CanSource&) = delete;

  /// Opens the interfaces that exist. Returns a message for each bus that is missing, down, or has
  /// too small a receive buffer.
  std::vector<std::string> open();
  /// Reads this descriptor for a bus instead of an interface, and never reopens it.
  void attach(int bus, int descriptor);

  /// Appends the descriptors to wait for to `out`.
  void descriptors(std::vector<pollfd>& out) const;
  /// Reads the frames that wait and sends SYNCs that are due. `now_us` is a monotonic clock.
  void handle(std::int64_t now_us);

  std::int64_t dropped() const;  ///< frames lost to full receive queues
  struct BusState {
    bool open = false;  ///< open, and the interface is up
    std::int64_t downs = 0;
  };
  BusState state(int bus) const { return buses_[static_cast<std::size_t>(bus)].state; }
  std::int64_t clock_steps() const;  ///< steps of the host's clock that were removed

 private:
  struct Bus {
    CanSocket socket;
    ContinuousStamps stamps;
    bool attached = false;
    Descriptor timer;  ///< sends the SYNC; negative: no timer
    std::int64_t syncs = 0;
    BusState state;
    std::int64_t dropped_before = 0;  ///< dropped by sockets that are closed now
    std::int64_t poll_again_us = 0;
  };
  bool open_bus(std::size_t bus, std::string& error);
  void poll_interface(std::size_t bus, std::int64_t now_us);
  void lose(Bus& bus);
  void read(std::size_t bus);
  void send_sync(std::size_t bus);
  void start_node(const Bus& bus, std::uint8_t node) const;

  const CanMap& map_;
  bool everything_;
  Handler handler_;
  std::vector<Bus> buses_;
  std::vector<CanFrame> batch_;
};

/// Returns the filters for the ids that the nodes of a bus use, their SYNC and CANopen's services.
std::vector<CanFilter> filters_of(const CanMap& map, int bus);

}  // namespace framewatch::drivers
