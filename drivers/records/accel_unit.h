#pragma once

#include <optional>
#include <string_view>

namespace framewatch::drivers {

constexpr double kStandardGravity_mps2 = 9.80665;
constexpr double kGal_mps2 = 0.01;

/// m/s^2 in one of a unit of acceleration as people write it: "g" (9.80665), "mg", "gal" (0.01),
/// "mps2", "m/s2", "m/s^2", "cm/s2", "mm/s^2" and the like. Empty for any other text.
std::optional<double> mps2_per(std::string_view unit);

/// Newtons in one of a unit of force: "N", "kN". Empty for any other text.
std::optional<double> newtons_per(std::string_view unit);

/// What --unit takes: such a unit, or a positive number of m/s^2, of a converter's count say.
std::optional<double> declared_unit(std::string_view text);

/// Seconds in one of a unit of time: "s", "ms", "us", "ns". Empty for any other text.
std::optional<double> seconds_per(std::string_view unit);

}  // namespace framewatch::drivers
