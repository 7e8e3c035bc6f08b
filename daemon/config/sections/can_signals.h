#pragma once

#include <string>
#include <vector>

#include "daemon/config/sections/can_buses.h"

namespace framewatch::daemon {

/// A signal with its message, or the problem that kept it from being found.
struct CanSignal {
  const drivers::DbcMessage* message = nullptr;
  const drivers::DbcSignal* signal = nullptr;
  std::string problem;
};

/// "Message.Signal" of a bus' DBC files.
CanSignal find_can_signal(const CanBusReading& bus, const std::string& text);
/// Null when there is none.
const drivers::DbcMessage* find_can_message(const CanBusReading& bus, const std::string& name);
std::string unknown_can_message(const CanBusReading& bus, const std::string& name);
/// ", did you mean X?" or nothing.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace framewatch::daemon
