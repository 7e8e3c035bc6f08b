// SPDX-License-Identifier: MIT
#include <net/if.h>
#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <thread>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "drivers/can/can_encoder.h"
#include "tests/guest/inner/guest.h"

namespace framewatch::test {
namespace {

using Clock = std::chrono::steady_clock;

/// A simulated serial adapter on a pseudo terminal, plugged in as long as this object exists.
class Adapter {
 public:
  Adapter() {
    termios settings{};
    ::cfmakeraw(&settings);
    settings.c_cflag |= CS8 | CREAD | CLOCAL;
    if (::openpty(&adapter_, &kernel_, nullptr, &settings, nullptr) != 0)
      throw std::runtime_error("openpty");
    const int discipline = 17;  // N_SLCAN
    char name[IFNAMSIZ] = {};
    if (::ioctl(kernel_, TIOCSETD, &discipline) != 0 || ::ioctl(kernel_, SIOCGIFNAME, name) != 0)
      throw std::runtime_error("slcan");
    name_ = name;
    // The driver waits until the adapter has read its commands.
    listener_ = std::thread([this] {
      char ignored[256];
      while (!gone_) {
        pollfd waiting{adapter_, POLLIN, 0};
        if (::poll(&waiting, 1, 20) > 0 && (waiting.revents & POLLIN) != 0 &&
            ::read(adapter_, ignored, sizeof ignored) < 0)
          return;
      }
    });
    up();
  }
  ~Adapter() {
    gone_ = true;
    listener_.join();
    ::close(adapter_);
    ::close(kernel_);
  }
  const std::string& name() const { return name_; }
  void up() const { shell("ip link set " + name_ + " up type can bitrate 500000"); }
  void down() const { shell("ip link set " + name_ + " down"); }
  /// Returns the text that the adapter writes for a frame.
  void say(const std::string& text) const {
    const std::string line = text + "\r";
    EXPECT_EQ(::write(adapter_, line.data(), line.size()), static_cast<ssize_t>(line.size()));
  }
  void send(const drivers::CanFrame& f) const {
    std::string text = fmt::format("t{:03X}{}", f.id, f.length);
    for (std::size_t i = 0; i < f.length; ++i) text += fmt::format("{:02X}", f.data[i]);
    say(text);
  }

 private:
  int adapter_ = -1, kernel_ = -1;
  std::atomic<bool> gone_ = false;
  std::thread listener_;
  std::string name_;
};

TEST(Slcan, SurvivesAndCountsBusOffAndAnUnpluggedAdapter) {
  auto adapter = std::make_unique<Adapter>();
  const daemon::Config config = example_on("raw_int16", adapter->name());
  LiveBuses live(config);
  drivers::CanEncoder encoder(config.can);
  int instant = 0, step = 0;
  std::int64_t first_samples = 0;
  constexpr int kInstants = 900;
  auto due = Clock::now();
  // Nodes count on in any state of the bus.
  live.run([&] {
    while (Clock::now() >= due && instant < kInstants) {
      const auto frames = encoder.instant({0.001 * instant, -0.001 * instant});
      const bool off = (instant >= 200 && instant < 260) || !adapter;
      if (instant == 100) adapter->say("sw100000");
      if (instant == 150) adapter->say("sp200010");
      if (instant == 200) adapter->say("sb000256");
      if (instant == 250) adapter->down(), ++step;
      if (instant == 255) adapter->up(), ++step;
      if (instant == 500) adapter.reset(), ++step;
      if (instant == 600) {
        first_samples = live.estimation.can().node(0).received;
        adapter = std::make_unique<Adapter>(), ++step;
        EXPECT_EQ(adapter->name(), config.can.buses[0].interface);
      }
      if (!off && adapter)
        for (const drivers::BusFrame& f : frames) adapter->send(f.frame);
      ++instant;
      due += std::chrono::milliseconds(10);
    }
    return instant == kInstants;
  });
  EXPECT_EQ(step, 4);
  const drivers::CanBusCounters& bus = live.estimation.can().buses()[0];
  EXPECT_EQ(bus.bus_off, 1);
  EXPECT_GE(bus.error_frames, 3);
  EXPECT_EQ(live.source.state(0).downs, 2);
  std::int64_t lost = 0;
  for (std::size_t n = 0; n < 2; ++n) {
    const drivers::CanNodeCounters c = live.estimation.can().node(n);
    EXPECT_EQ(c.received + c.lost, kInstants);
    EXPECT_GE(c.lost, 160);
    EXPECT_GT(c.received, first_samples + 200) << "did not resume";
    lost += c.lost;
  }
  fmt::print("bus-off, down and up, unplugged and plugged: {} frames lost, all counted\n", lost);
}

}  // namespace
}  // namespace framewatch::test
