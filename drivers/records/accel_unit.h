#pragma once

#include <optional>
#include <string_view>

namespace framewatch::drivers {

/// Unit of the accelerations in a record file.
enum class AccelUnit { g, gal, mps2 };

/// "g" (9.80665 m/s^2), "gal" (0.01 m/s^2), "mps2"; empty for any other name.
std::optional<AccelUnit> accel_unit(std::string_view name);
/// m/s^2 in one of this unit.
double mps2_per(AccelUnit unit);

}  // namespace framewatch::drivers
