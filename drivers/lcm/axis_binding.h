#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
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

/// Finds the sensor axis that an axis of a node on an LCM channel is. An axis with a configured
/// address is found there, whatever a channel table says; one without is found where a table names
/// it, and stays there while samples come from that node.
class AxisBinding {
 public:
  static constexpr int kNone = -1;
  using NodeAxes = std::array<int, 3>;  ///< sensor axis of x, y, z, or kNone

  /// What a table says against the binding of a wanted axis: its name elsewhere, or another name at
  /// its address. The names that records without any get, node<k>.<axis>, say nothing.
  struct Contradiction {
    std::size_t wanted = 0;
    ChannelTable::Entry told;
    bool elsewhere = false;
  };
  /// Whether nothing has come from a node for long.
  using IsSilent = std::function<bool(const std::string& stream, std::int32_t node)>;

  explicit AxisBinding(std::vector<WantedAxis> wanted);

  /// Binds what the table names and may be bound; gives back what it contradicts, which changes
  /// nothing, once for each axis. Without is_silent no samples come.
  std::vector<Contradiction> apply(const std::string& stream, const ChannelTable& table,
                                   const IsSilent& is_silent = {});
  /// Null when no wanted axis is on this node of this stream.
  const NodeAxes* axes_of(const std::string& stream, std::int32_t node) const;
  bool carries(const std::string& stream) const { return bound_.contains(stream); }
  /// Streams to listen to: every configured one, and ACCEL when an axis has no address.
  std::vector<std::string> streams() const;
  /// Names of the axes that no stream carries so far.
  std::vector<std::string> unbound() const;

  /// Of what tables have bound.
  template <typename Archive>
  void archive(Archive& a) {
    std::vector<std::size_t> named;
    for (std::size_t i = 0; i < wanted_.size(); ++i)
      if (place_[i] && wanted_[i].node < 0) named.push_back(i);
    named.resize(a.count(named.size()));
    for (std::size_t& i : named) {
      const bool known = !Archive::kReading;
      Place place = known ? *place_[i] : Place{};
      a(i, place.stream, place.node, place.axis);
      if (Archive::kReading && i < wanted_.size() && wanted_[i].node < 0) give(i, place);
    }
  }

 private:
  struct Place {
    std::string stream;
    std::int32_t node = 0;
    int axis = 0;
    bool operator==(const Place&) const = default;
  };
  bool give(std::size_t wanted, const Place& place);
  void take(std::size_t wanted);
  /// The axis bound to the place, or kNone.
  int axis_at(const Place& place) const;

  std::vector<WantedAxis> wanted_;
  std::map<std::string, std::size_t> by_name_;  ///< those on LCM
  std::map<std::string, std::map<std::int32_t, NodeAxes>, std::less<>> bound_;
  std::vector<std::optional<Place>> place_;  ///< by wanted axis
};

}  // namespace framewatch::drivers
