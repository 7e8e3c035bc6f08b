// SPDX-License-Identifier: MIT
#include "drivers/lcm/axis_binding.h"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

namespace framewatch::drivers {
namespace {

bool is_placeholder(const ChannelTable::Entry& entry) {
  return entry.axis >= 0 && entry.axis <= 2 &&
         entry.name == fmt::format("node{}.{}", entry.node, "xyz"[entry.axis]);
}

}  // namespace

AxisBinding::AxisBinding(std::vector<WantedAxis> wanted)
    : wanted_(std::move(wanted)), place_(wanted_.size()) {
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    const WantedAxis& w = wanted_[i];
    if (w.on_lcm) by_name_.emplace(w.name, i);
    if (w.node >= 0) give(i, {w.lcm_channel, w.node, w.axis});
  }
}

std::vector<AxisBinding::Contradiction> AxisBinding::apply(const std::string& stream,
                                                           const ChannelTable& table,
                                                           const IsSilent& is_silent) {
  std::map<std::size_t, ChannelTable::Entry> against;
  std::map<std::size_t, Place> moves;
  for (const ChannelTable::Entry& entry : table.entries) {
    const Place told{stream, entry.node, entry.axis};
    const auto name = by_name_.find(entry.name);
    if (name == by_name_.end()) continue;
    const std::size_t i = name->second;
    const std::optional<Place>& place = place_[i];
    if (place == told || told.axis < 0 || told.axis > 2) continue;
    const bool stays = wanted_[i].node >= 0 || moves.contains(i) ||
                       (place && is_silent && !is_silent(place->stream, place->node));
    if (!stays)
      moves.emplace(i, told);
    else if (moves.find(i) == moves.end() || moves[i] != told)
      against.emplace(i, entry);
  }
  std::map<std::size_t, Place> before;
  for (const auto& [i, told] : moves) {
    if (place_[i]) before.emplace(i, *place_[i]);
    take(i);
  }
  for (const auto& [i, told] : moves)
    if (!give(i, told) && before.contains(i)) give(i, before[i]);
  for (const ChannelTable::Entry& entry : table.entries) {
    const int there = axis_at({stream, entry.node, entry.axis});
    if (there == kNone || wanted_[static_cast<std::size_t>(there)].name == entry.name) continue;
    if (!is_placeholder(entry)) against.emplace(static_cast<std::size_t>(there), entry);
  }
  std::vector<Contradiction> out;
  for (auto& [i, entry] : against) {
    const bool elsewhere = entry.name == wanted_[i].name;
    out.push_back({i, std::move(entry), elsewhere});
  }
  return out;
}

bool AxisBinding::give(std::size_t wanted, const Place& place) {
  if (place_[wanted] || place.axis < 0 || place.axis > 2 || axis_at(place) != kNone) return false;
  NodeAxes& axes =
      bound_[place.stream].try_emplace(place.node, NodeAxes{kNone, kNone, kNone}).first->second;
  axes[static_cast<std::size_t>(place.axis)] = static_cast<int>(wanted);
  place_[wanted] = place;
  return true;
}

void AxisBinding::take(std::size_t wanted) {
  if (!place_[wanted]) return;
  const Place place = *std::exchange(place_[wanted], std::nullopt);
  const auto stream = bound_.find(place.stream);
  const auto node = stream->second.find(place.node);
  node->second[static_cast<std::size_t>(place.axis)] = kNone;
  if (node->second == NodeAxes{kNone, kNone, kNone}) stream->second.erase(node);
  if (stream->second.empty()) bound_.erase(stream);
}

int AxisBinding::axis_at(const Place& place) const {
  const NodeAxes* axes = axes_of(place.stream, place.node);
  if (axes == nullptr || place.axis < 0 || place.axis > 2) return kNone;
  return (*axes)[static_cast<std::size_t>(place.axis)];
}

const AxisBinding::NodeAxes* AxisBinding::axes_of(const std::string& stream,
                                                  std::int32_t node) const {
  const auto nodes = bound_.find(stream);
  if (nodes == bound_.end()) return nullptr;
  const auto axes = nodes->second.find(node);
  return axes == nodes->second.end() ? nullptr : &axes->second;
}

std::vector<std::string> AxisBinding::streams() const {
  std::vector<std::string> streams;
  for (const WantedAxis& wanted : wanted_)
    if (wanted.on_lcm) streams.push_back(wanted.node >= 0 ? wanted.lcm_channel : "ACCEL");
  std::sort(streams.begin(), streams.end());
  streams.erase(std::unique(streams.begin(), streams.end()), streams.end());
  return streams;
}

std::vector<std::string> AxisBinding::unbound() const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < wanted_.size(); ++i)
    if (wanted_[i].on_lcm && !place_[i]) names.push_back(wanted_[i].name);
  return names;
}

}  // namespace framewatch::drivers
