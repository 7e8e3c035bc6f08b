#include "daemon/tools/demo/demo_can.h"

#include <cstdint>
#include <utility>

namespace framewatch::daemon {
namespace {

constexpr drivers::CanField kAccel{0, 24, true, true, drivers::CanValue::integer, 1e-5, 0};
constexpr drivers::CanField kCount{24, 16, true, false, drivers::CanValue::integer, 1, 0};
constexpr int kLength_bytes = 5;
constexpr std::uint32_t kFirstTpdo = 0x181;

}  // namespace

void put_on_can(Config& config, const std::string& interface) {
  const double period_us = 1e6 / config.pipeline.options.rate_hz;
  drivers::CanBusMap bus;
  bus.interface = interface;
  bus.sync_period_us = period_us;
  bus.sync_overflow = 240;
  config.can = {};
  config.can.buses = {bus};
  config.can.grid_period_us = period_us;
  for (std::size_t i = 0; i < config.sources.size(); ++i) {
    const std::string& name = config.pipeline.axes[i].name;
    config.sources[i] = {"", -1, 0, interface, "Accel.X", name};
    drivers::CanMessageMap message;
    message.name = "Accel";
    message.id = kFirstTpdo + static_cast<std::uint32_t>(i);
    message.mask = 0x7FF;
    message.length = kLength_bytes;
    message.readings = {{kAccel, static_cast<int>(i), 0, "X"}};
    message.counter = kCount;
    drivers::CanNodeMap node;
    node.name = name;
    node.timing = drivers::CanTiming::sync;
    node.period_us = period_us;
    node.canopen_id = static_cast<int>(i) + 1;
    node.messages = {std::move(message)};
    config.can.nodes.push_back(std::move(node));
  }
}

}  // namespace framewatch::daemon
