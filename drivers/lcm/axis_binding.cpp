#include "drivers/lcm/axis_binding.h"

#include <algorithm>
#include <utility>

namespace framewatch::drivers {

AxisBinding::AxisBinding(std::vector<WantedAxis> wanted) : wanted_(std::move(wanted)) {
  bind();
}

void AxisBinding::apply(const std::string& stream, const ChannelTable& table) {
  const auto known = tables_.find(stream);
  if (known != tables_.end() && known->second == table) return;
  const auto is_wanted = [this](const ChannelTable::Entry& entry) {
    return std::any_of(wanted_.begin(), wanted_.end(), [&](const WantedAxis& wanted) {
      return wanted.on_lcm && wanted.name == entry.name;
    });
  };
  if (std::none_of(table.entries.begin(), table.entries.end(), is_wanted)) return;
  tables_[stream] = table;
  bind();
}

bool AxisBinding::give(std::size_t wanted, const std::string& stream, std::int32_t node, int axis) {
  if (is_bound_[wanted] || axis < 0 || axis > 2) return false;
  NodeAxes& axes = bound_[stream].try_emplace(node, NodeAxes{kNone, kNone, kNone}).first->second;
  int& place = axes[static_cast<std::size_t>(axis)];
  if (place != kNone) return false;
  place = static_cast<int>(wanted);
  is_bound_[wanted] = true;
  return true;
}

void AxisBinding::bind() {
  bound_.clear();
  is_bound_.assign(wanted_.size(), false);
  for (const auto& [stream, table] : tables_)
    for (const ChannelTable::Entry& entry : table.entries)
      for (std::size_t i = 0; i < wanted_.size(); ++i)
        if (wanted_[i].on_lcm && wanted_[i].name == entry.name)
          give(i, stream, entry.node, entry.axis);
  for (std::size_t i = 0; i < wanted_.size(); ++i)
    if (wanted_[i].node >= 0) give(i, wanted_[i].lcm_channel, wanted_[i].node, wanted_[i].axis);
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
    if (wanted_[i].on_lcm && !is_bound_[i]) names.push_back(wanted_[i].name);
  return names;
}

}  // namespace framewatch::drivers
