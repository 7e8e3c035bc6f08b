// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "drivers/lcm/accel_codec.h"

namespace framewatch::drivers {

/// One sensor axis of the configuration and the address of its samples.
struct WantedAxis {
  std::string name;
  std::string lcm_channel;
  std::int32_t node = -1;  ///< negative: no address, found by name
  int axis = 0;
  bool on_lcm = true;  ///< false: its samples come another way
};

/// Finds the sensor axis for an axis of a node on an LCM channel. An axis with a configured address
/// is bound to it, whatever a channel table says. An axis without an address is bound where a table
/// names it, and stays there while samples come from that node.
class AxisBinding {
 public:
  static constexpr int kNone = -1;
  using NodeAxes = std::array<int, 3>;  ///< sensor axis of x, y, z, or kNone

  /// An entry of a table that contradicts the binding of a wanted axis: its name elsewhere, or
  /// another name at its address. Placeholder names, node<k>.<axis>, contradict nothing.
  struct Contradiction {
    std::size_t wanted = 0;
    ChannelTable::Entry told;
    bool elsewhere = false;
  };
  /// Returns true if a node has been silent for long.
  using IsSilent = std::function<bool(const std::string& stream, std::int32_t node)>;

  explicit AxisBinding(std::vector<WantedAxis> wanted);

  /// Binds the axes that the table names and that may be bound. Returns its contradictions, one for
  /// each axis, which change no binding. Without `is_silent` every node counts as silent.
  std::vector<Contradiction> apply(const std::string& stream, const ChannelTable& table,
                                   const IsSilent& is_silent = {});
  /// Returns the axes of a node of a stream; null when it carries no wanted axis.
  const NodeAxes* axes_of(const std::string& stream, std::int32_t node) const;
  bool carries(const std::string& stream) const { return bound_.contains(stream); }
  /// Returns the streams to listen to: every configured one, and ACCEL when an axis has no address.
  std::vector<std::string> streams() const;
  /// Returns the names of the axes that are not bound yet.
  std::vector<std::string> unbound() const;

  /// Writes or reads the bindings by tables.
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
  /// Returns the axis bound to the place, or kNone.
  int axis_at(const Place& place) const;

  std::vector<WantedAxis> wanted_;
  std::map<std::string, std::size_t> by_name_;  ///< axes on LCM
  std::map<std::string, std::map<std::int32_t, NodeAxes>, std::less<>> bound_;
  std::vector<std::optional<Place>> place_;  ///< by wanted axis
};

}  // namespace framewatch::drivers
