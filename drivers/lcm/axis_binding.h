#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "drivers/lcm/channel_table.h"

namespace framewatch::drivers {

/// One sensor axis of the configuration and where it says its samples come from.
struct WantedAxis {
  std::string name;
  std::string lcm_channel;
  std::int32_t node = -1;  ///< < 0: no address, found by name only
  int axis = 0;
  bool on_lcm = true;  ///< else its samples come another way
};

/// Finds the sensor axis that an axis of a node on an LCM channel is. Names in a stream's channel
/// table bind first; an axis whose name is in no table is found at its configured address, unless
/// the table gives that address to another one.
class AxisBinding {
 public:
  static constexpr int kNone = -1;
  using NodeAxes = std::array<int, 3>;  ///< sensor axis of x, y, z, or kNone

  explicit AxisBinding(std::vector<WantedAxis> wanted);

  /// A table without any wanted name changes nothing.
  void apply(const std::string& stream, const ChannelTable& table);
  /// Null when no wanted axis is on this node of this stream.
  const NodeAxes* axes_of(const std::string& stream, std::int32_t node) const;
  bool carries(const std::string& stream) const { return bound_.contains(stream); }
  /// Streams to listen to: every configured one, and ACCEL when an axis has no address.
  std::vector<std::string> streams() const;
  /// Names of the axes that no stream carries so far.
  std::vector<std::string> unbound() const;

  template <typename Archive>
  void archive(Archive& a) {
    std::vector<std::pair<std::string, ChannelTable>> tables(tables_.begin(), tables_.end());
    tables.resize(a.count(tables.size()));
    for (auto& [stream, table] : tables) a(stream, table);
    if constexpr (!Archive::kReading) return;
    tables_ = {tables.begin(), tables.end()};
    bind();
  }

 private:
  void bind();
  bool give(std::size_t wanted, const std::string& stream, std::int32_t node, int axis);

  std::vector<WantedAxis> wanted_;
  std::map<std::string, ChannelTable> tables_;
  std::map<std::string, std::map<std::int32_t, NodeAxes>, std::less<>> bound_;
  std::vector<bool> is_bound_;
};

}  // namespace framewatch::drivers
