#pragma once

#include <poll.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "drivers/can/can_map.h"
#include "drivers/can/can_socket.h"
#include "drivers/can/host_clock.h"

namespace framewatch::drivers {

/// Reads every bus of a map, and opens again what goes away. With `nmt_start` and `send_sync` it
/// also starts the CANopen nodes and gives them their SYNC.
class CanSource {
 public:
  using Handler = std::function<void(int bus, const CanFrame& frame)>;

  /// `map` must outlive this. `everything`: no filters, for a recorder.
  CanSource(const CanMap& map, bool everything, Handler handler);
  ~CanSource();
  CanSource(const CanSource&) = delete;
  CanSource& operator=(const CanSource&) = delete;

  /// Opens what is there. One message for each bus that is not, or is not as it should be.
  std::vector<std::string> open();
  /// Uses this descriptor for a bus instead of an interface; never opened again.
  void attach(int bus, int descriptor);

  /// Descriptors to wait for.
  void descriptors(std::vector<pollfd>& out) const;
  /// Takes what is there, sends what is due. `now_us` is a monotonic clock.
  void handle(std::int64_t now_us);

  std::int64_t dropped() const;  ///< frames, by full receive queues
  struct BusState {
    bool open = false;  ///< and up
    std::int64_t downs = 0;
  };
  BusState state(int bus) const { return buses_[static_cast<std::size_t>(bus)].state; }
  std::int64_t clock_steps() const;  ///< of the host's clock, taken out

 private:
  struct Bus {
    CanSocket socket;
    ContinuousStamps stamps;
    bool attached = false;
    int timer = -1;  ///< of the SYNC; -1: none
    std::int64_t syncs = 0;
    BusState state;
    std::int64_t dropped_before = 0;  ///< by sockets that are closed
    std::int64_t look_again_us = 0;
  };
  bool open_bus(std::size_t bus, std::string& error);
  void look(std::size_t bus, std::int64_t now_us);
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

/// The ids that the nodes of a bus use, their SYNC and CANopen's services.
std::vector<CanFilter> filters_of(const CanMap& map, int bus);

}  // namespace framewatch::drivers
