#include "drivers/records/accel_unit.h"

#include <array>
#include <utility>

namespace framewatch::drivers {
namespace {

constexpr std::array<std::pair<std::string_view, AccelUnit>, 3> kUnits = {{
    {"g", AccelUnit::g},
    {"gal", AccelUnit::gal},
    {"mps2", AccelUnit::mps2},
}};

}  // namespace

std::optional<AccelUnit> accel_unit(std::string_view name) {
  for (const auto& [known, unit] : kUnits)
    if (known == name) return unit;
  return std::nullopt;
}

double mps2_per(AccelUnit unit) {
  switch (unit) {
    case AccelUnit::g:
      return 9.80665;
    case AccelUnit::gal:
      return 0.01;
    case AccelUnit::mps2:
      break;
  }
  return 1.0;
}

}  // namespace framewatch::drivers
