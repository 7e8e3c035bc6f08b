#include "daemon/config/sections/can_reader.h"

#include <algorithm>

#include <fmt/core.h>

namespace framewatch::daemon {

using drivers::CanMessageMap;
using drivers::CanNodeMap;
using drivers::CanTiming;

void CanConfigReader::node_problem(CanNodeReading& node, const std::string& key,
                                   const std::string& message) {
  if (node.section)
    node.section->problem(key, message);
  else
    problems_.push_back({{}, fmt::format("can: message {}: {}", node.map.name, message)});
}

void CanConfigReader::finish_node(CanNodeReading& node) {
  if (node.map.messages.empty()) return;
  const CanSignal& stamp = node.map.timing == CanTiming::clock ? node.clock : node.counter;
  std::string opens = stamp.message != nullptr ? stamp.message->name : "";
  if (stamp.signal != nullptr) {
    const bool carried = std::any_of(node.map.messages.begin(), node.map.messages.end(),
                                     [&](const CanMessageMap& m) { return m.name == opens; });
    if (!carried) message_map(node, *stamp.message, nullptr, std::nullopt);
    for (CanMessageMap& m : node.map.messages)
      if (m.name == opens)
        (node.map.timing == CanTiming::clock ? m.clock : m.counter) = stamp.signal->field;
  }
  const auto rank = [&](const CanMessageMap& m) {
    if (m.name == opens) return std::ptrdiff_t{-1};
    return std::find(node.messages.begin(), node.messages.end(), m.name) - node.messages.begin();
  };
  std::stable_sort(
      node.map.messages.begin(), node.map.messages.end(),
      [&](const CanMessageMap& a, const CanMessageMap& b) { return rank(a) < rank(b); });
  const drivers::CanBusMap& bus = config_.can.buses[node.bus];
  for (const CanMessageMap& m : node.map.messages) {
    if (m.fd && !bus.fd)
      node_problem(node, "messages",
                   fmt::format("{} has {} bytes: fd = true is missing for {}", m.name, m.length,
                               bus.interface));
    if (m.id > (m.extended ? 0x1FFFFFFFu : 0x7FFu))
      node_problem(node, "id_offset", fmt::format("id {:X} of {} is too large", m.id, m.name));
    if (node.j1939 && !m.extended)
      node_problem(node, "j1939", fmt::format("{} has an 11-bit id", m.name));
    if (node.map.timing == CanTiming::sync && !m.extended && m.id == bus.sync_id)
      node_problem(node, "messages", fmt::format("{} has the id of the SYNC", m.name));
  }
  config_.can.nodes.push_back(node.map);
}

void CanConfigReader::check_ids() {
  const auto& nodes = config_.can.nodes;
  for (std::size_t b = 1; b < nodes.size(); ++b)
    for (std::size_t a = 0; a < b; ++a)
      if (nodes[a].bus == nodes[b].bus) check_pair(nodes[a], nodes[b]);
}

void CanConfigReader::check_pair(const CanNodeMap& a, const CanNodeMap& b) {
  for (const CanMessageMap& m : a.messages)
    for (const CanMessageMap& n : b.messages) {
      if (m.extended != n.extended || ((m.id ^ n.id) & m.mask & n.mask) != 0) continue;
      const auto of = std::find_if(nodes_.begin(), nodes_.end(), [&](const CanNodeReading& node) {
        return node.map.name == b.name;
      });
      return node_problem(*of, "messages",
                          fmt::format("{} has an id that {} of node {} has too: {:X}", n.name,
                                      m.name, a.name, n.id));
    }
}

}  // namespace framewatch::daemon
