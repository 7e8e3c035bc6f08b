#include "drivers/records/accel_unit.h"

#include <array>
#include <cctype>
#include <cmath>
#include <string>
#include <utility>

#include "drivers/files/number_text.h"

namespace framewatch::drivers {
namespace {

struct NamedUnit {
  std::string_view name;
  double in_si;
};

constexpr std::array kAccelUnits = {
    NamedUnit{"g", 9.80665},   NamedUnit{"mg", 9.80665e-3}, NamedUnit{"gal", 0.01},
    NamedUnit{"mps2", 1},      NamedUnit{"m/s2", 1},        NamedUnit{"m/s/s", 1},
    NamedUnit{"m/sec2", 1},    NamedUnit{"ms-2", 1},        NamedUnit{"cm/s2", 0.01},
    NamedUnit{"cm/s/s", 0.01}, NamedUnit{"cm/sec2", 0.01},  NamedUnit{"cms-2", 0.01},
    NamedUnit{"mm/s2", 0.001}, NamedUnit{"mm/s/s", 0.001},  NamedUnit{"mms-2", 0.001},
};
constexpr std::array kForceUnits = {NamedUnit{"n", 1}, NamedUnit{"kn", 1e3}};
constexpr std::array kTimeUnits = {
    NamedUnit{"s", 1},       NamedUnit{"sec", 1},   NamedUnit{"second", 1}, NamedUnit{"ms", 1e-3},
    NamedUnit{"msec", 1e-3}, NamedUnit{"us", 1e-6}, NamedUnit{"ns", 1e-9},  NamedUnit{"seconds", 1},
};

/// "m / s^2", "m/s\u00b2", "m s^-2" and "m/s**2" become "m/s2", "ms-2": lower case, without what
/// only sets it out. The micro sign becomes a u.
std::string plain_unit(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const unsigned char c = static_cast<unsigned char>(text[i]);
    if (c == 0xC2 || c == 0xCE) continue;  // the first byte of these signs in UTF-8
    if (c == 0xB2)
      plain += '2';
    else if (c == 0xB5 || c == 0xBC)
      plain += 'u';
    else if (c != ' ' && c != '^' && c != '*' && c != '.' && c != 0xB7)
      plain += static_cast<char>(std::tolower(c));
  }
  return plain;
}

template <std::size_t Count>
std::optional<double> unit_of(const std::array<NamedUnit, Count>& units, std::string_view text) {
  const std::string plain = plain_unit(text);
  for (const NamedUnit& unit : units)
    if (unit.name == plain) return unit.in_si;
  return std::nullopt;
}

}  // namespace

std::optional<double> mps2_per(std::string_view unit) {
  return unit_of(kAccelUnits, unit);
}

std::optional<double> newtons_per(std::string_view unit) {
  return unit_of(kForceUnits, unit);
}

std::optional<double> declared_unit(std::string_view text) {
  if (const auto number = parse_number(text))
    return std::isfinite(*number) && *number > 0 ? number : std::nullopt;
  return mps2_per(text);
}

std::optional<double> seconds_per(std::string_view unit) {
  return unit_of(kTimeUnits, unit);
}

}  // namespace framewatch::drivers
