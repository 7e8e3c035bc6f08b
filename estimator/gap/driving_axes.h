#pragma once

#include <cstdint>
#include <vector>

#include "estimator/structure/sensors.h"

namespace framewatch::estimator {

/// Which axes show what moves the building: those of the base and forces, but for checks. One that
/// is lost for two seconds is done without, as long as every direction that was measured is
/// measured still, and every force; it counts again two seconds after it has come back.
class DrivingAxes {
 public:
  DrivingAxes(const std::vector<SensorAxis>& axes, double rate_hz);

  /// Values of all axes at the next instant, NaN: none. True when other axes count from now on.
  bool push(const std::vector<double>& values);
  /// Flags of all axes; those that move with the floors are present always.
  const std::vector<std::uint8_t>& present() const { return present_; }

  template <typename Archive>
  void archive(Archive& a) {
    std::vector<std::uint8_t> present = present_, seen = seen_;
    a(present, seen);
    a.within(steady_, 0, a.kMaxCount);
    if constexpr (Archive::kReading)
      if (!restore(present, seen)) a.refuse();
  }

 private:
  static constexpr double kSteady_s = 2;
  bool drives(std::size_t axis) const;
  bool enough(const std::vector<std::uint8_t>& present) const;
  bool restore(const std::vector<std::uint8_t>& present, const std::vector<std::uint8_t>& seen);

  std::vector<SensorAxis> axes_;
  std::vector<std::uint8_t> all_, present_, seen_;
  int steady_ = 0;  ///< instants with the same seen_
  int enough_instants_;
};

}  // namespace framewatch::estimator
