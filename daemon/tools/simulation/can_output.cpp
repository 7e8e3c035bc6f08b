#include "daemon/tools/simulation/can_output.h"

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>
#include <utility>

#include <fmt/core.h>

#include "drivers/can/bus_load.h"
#include "drivers/can/can_encoder.h"
#include "drivers/can/can_socket.h"

namespace framewatch::daemon {
namespace {

constexpr int kSmallBuffer_bytes = 4096;
constexpr auto kWorthSleeping = std::chrono::milliseconds(1);
/// Making and closing a CAN socket takes the kernel milliseconds, and the nodes must not fall
/// behind.
constexpr auto kLookAgain = std::chrono::milliseconds(50);
/// An id nobody has: the sender reads nothing.
const std::vector<drivers::CanFilter> kNothing{{0x1FFFFFFF, 0x1FFFFFFF, true}};

class CanOutput : public SimulationOutput {
 public:
  CanOutput(const Scenario& s, const std::string& interface, double speed)
      : map_(s.config.can), encoder_(map_), speed_(speed) {
    for (const drivers::CanBusMap& bus : map_.buses)
      interfaces_.push_back(interface.empty() ? bus.interface : interface);
    sockets_.resize(interfaces_.size());
    look_again_.resize(interfaces_.size());
  }

  bool open(std::string& error) {
    for (std::size_t b = 0; b < sockets_.size(); ++b) {
      bool up = false;
      if (!open_bus(b, error)) return false;
      if (drivers::find_interface(interfaces_[b], up) == 0 || !up) {
        error = interfaces_[b] + ": the interface is down";
        return false;
      }
    }
    return true;
  }

  bool put(double time_s, const std::vector<double>& raw) override {
    if (!started_) start_ = Clock::now();
    started_ = true;
    std::vector<double> free_s(sockets_.size(), 0);
    for (const drivers::BusFrame& f : encoder_.instant(raw)) {
      const auto b = static_cast<std::size_t>(f.bus);
      const drivers::CanBusMap& bus = map_.buses[b];
      free_s[b] += drivers::worst_frame_s(f.frame.length, f.frame.extended, f.frame.fd,
                                          bus.bit_rate, bus.data_bit_rate);
      const std::chrono::duration<double> due((time_s + free_s[b]) / speed_);
      const auto at = start_ + std::chrono::duration_cast<Clock::duration>(due);
      if (at - Clock::now() > kWorthSleeping) std::this_thread::sleep_until(at);
      if (!send(b, f.frame)) ++unsent_;
    }
    return true;
  }

  bool close() override {
    if (unsent_ > 0) fmt::print(stderr, "framewatch simulate: {} frames found no bus\n", unsent_);
    return true;
  }
  std::string error() const override { return "CAN refuses to send"; }

 private:
  using Clock = std::chrono::steady_clock;

  bool open_bus(std::size_t b, std::string& error) {
    return sockets_[b].open(interfaces_[b], kSmallBuffer_bytes, kNothing, false, error);
  }

  bool send(std::size_t b, const drivers::CanFrame& frame) {
    constexpr int kTries = 2000;
    constexpr auto kPause = std::chrono::microseconds(500);
    std::string error;
    if (!sockets_[b].is_open()) {
      const Clock::time_point now = Clock::now();
      if (now < look_again_[b]) return false;
      look_again_[b] = now + kLookAgain;
      if (!open_bus(b, error)) return false;
    }
    for (int i = 0; i < kTries; ++i) {
      if (sockets_[b].write(frame)) return true;
      if (errno != ENOBUFS && errno != EAGAIN) break;
      std::this_thread::sleep_for(kPause);
    }
    if (errno != ENETDOWN) sockets_[b] = drivers::CanSocket();
    return false;
  }

  const drivers::CanMap& map_;
  drivers::CanEncoder encoder_;
  double speed_;
  std::vector<std::string> interfaces_;
  std::vector<drivers::CanSocket> sockets_;
  std::vector<Clock::time_point> look_again_;  ///< for an interface that is not there
  bool started_ = false;
  Clock::time_point start_;
  std::int64_t unsent_ = 0;
};

}  // namespace

std::unique_ptr<SimulationOutput> can_output(const Scenario& s, const std::string& interface,
                                             double speed, std::string& error) {
  if (s.config.can.empty()) {
    error = s.config.path + ": no channel has a source on CAN";
    return nullptr;
  }
  if (!interface.empty() && s.config.can.buses.size() > 1) {
    error = "--can names one interface and the configuration has several";
    return nullptr;
  }
  auto out = std::make_unique<CanOutput>(s, interface, speed);
  if (!out->open(error)) return nullptr;
  return out;
}

}  // namespace framewatch::daemon
