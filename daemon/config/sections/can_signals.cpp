#include "daemon/config/sections/can_signals.h"

#include <algorithm>

#include <fmt/core.h>

#include "daemon/config/keys/suggest.h"

namespace framewatch::daemon {

using drivers::DbcMessage;
using drivers::DbcSignal;

std::string did_you_mean(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string meant = nearest(word, candidates);
  return meant.empty() ? "" : fmt::format(", did you mean {}?", meant);
}

const DbcMessage* find_can_message(const CanBusReading& bus, const std::string& name) {
  const auto at = std::find_if(bus.messages.begin(), bus.messages.end(),
                               [&](const DbcMessage& m) { return m.name == name; });
  return at == bus.messages.end() ? nullptr : &*at;
}

std::string unknown_can_message(const CanBusReading& bus, const std::string& name) {
  std::vector<std::string> names;
  for (const DbcMessage& m : bus.messages) names.push_back(m.name);
  return fmt::format("no DBC file of the bus has the message {}{}", name,
                     did_you_mean(name, names));
}

CanSignal find_can_signal(const CanBusReading& bus, const std::string& text) {
  CanSignal found;
  const std::size_t dot = text.find('.');
  if (dot == std::string::npos) {
    found.problem = fmt::format("expected Message.Signal, got \"{}\"", text);
    return found;
  }
  const std::string message = text.substr(0, dot), signal = text.substr(dot + 1);
  found.message = find_can_message(bus, message);
  if (found.message == nullptr) {
    found.problem = unknown_can_message(bus, message);
    return found;
  }
  found.signal = found.message->find(signal);
  if (found.signal == nullptr) {
    std::vector<std::string> names;
    for (const DbcSignal& s : found.message->signals) names.push_back(s.name);
    found.problem =
        fmt::format("message {} has no signal {}{}", message, signal, did_you_mean(signal, names));
  }
  return found;
}

}  // namespace framewatch::daemon
