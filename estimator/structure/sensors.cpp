// SPDX-License-Identifier: MIT
#include "estimator/structure/sensors.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace framewatch::estimator {
namespace {

constexpr double kSteepest = M_PI / 3;

}  // namespace

bool has_force(const std::vector<SensorAxis>& axes) {
  return std::any_of(axes.begin(), axes.end(), [](const SensorAxis& a) { return a.is_force; });
}

std::vector<SensorAxis> horizontals(const std::vector<SensorAxis>& axes) {
  std::vector<SensorAxis> out;
  std::copy_if(axes.begin(), axes.end(), std::back_inserter(out),
               [](const SensorAxis& a) { return a.horizontal(); });
  return out;
}

std::vector<Problem> find_problems(const Structure& s, const std::vector<SensorAxis>& axes) {
  std::vector<Problem> found;
  std::set<std::string> names;
  std::map<std::tuple<int, int, bool>, std::string> places;
  std::set<Direction> base, above;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const SensorAxis& a = axes[i];
    const auto add = [&](const char* field, const std::string& rule) {
      found.push_back({field, static_cast<int>(i), "channel '" + a.name + "': " + rule});
    };
    if (a.name.empty()) add("name", "needs a name");
    if (!names.insert(a.name).second) add("name", "another channel has this name already");
    if (!std::isfinite(a.scale) || a.scale == 0) add("scale", "scale must not be 0");
    if (a.polarity != 1 && a.polarity != -1) add("polarity", "polarity must be 1 or -1");
    if (!std::isfinite(a.offset)) add("offset", "offset must be a number");
    if (!std::isfinite(a.delay)) add("delay_s", "delay must be a number");
    if (!(std::isfinite(a.noise_density) && a.noise_density >= 0))
      add("noise_mps2_per_rthz", "noise density must be 0 or more");
    if (!(std::isfinite(a.range) && a.range >= 0)) add("range_mps2", "range must be 0 or more");
    if (!(std::abs(a.tilt) <= kSteepest)) add("tilt_deg", "tilt must be within +-60 degrees");
    if (!(std::abs(a.mount_angle) <= kSteepest))
      add("mount_angle_deg", "mounting angle must be within +-60 degrees");
    else if (a.mount_angle != 0 && a.cross < 0)
      add("cross_channel", "an axis at an angle needs a cross_channel of the other direction");
    if (a.cross >= static_cast<int>(axes.size())) {
      add("cross_channel", "its cross channel does not exist");
    } else if (a.cross >= 0) {
      const SensorAxis& other = axes[static_cast<std::size_t>(a.cross)];
      if (other.direction == a.direction || other.story != a.story || other.is_force != a.is_force)
        add("cross_channel",
            "channel '" + other.name + "' does not measure the other direction on the same floor");
      else if (std::abs(a.mount_angle - other.mount_angle) > kSteepest)
        add("mount_angle_deg", "differs from that of '" + other.name +
                                   "' by more than 60 degrees: the axes are nearly parallel");
    }
    if (a.story < 0 || a.story > s.stories) {
      add("story", "story " + std::to_string(a.story) + " does not exist, 0 (base) to " +
                       std::to_string(s.stories) + " do");
      continue;
    }
    if (a.is_force && a.story == 0) {
      add("story", "a force on the base moves nothing: it acts on a floor, 1 to " +
                       std::to_string(s.stories));
      continue;
    }
    if (a.frame >= s.frames() || (a.story > 0 && a.frame < 0 && !a.plan)) {
      add("frame", "its frame does not exist");
      continue;
    }
    const Direction along = direction_of(s, a);
    if (a.horizontal()) (a.story == 0 ? base : above).insert(along);
    if (a.vertical) continue;
    if (a.plan) {
      if ((along == Direction::x ? s.n() : s.m()) == 0)
        add("direction", std::string("the building has no frame parallel to ") + letter(along));
      continue;
    }
    const int place = a.frame >= 0 ? a.frame : (a.direction == Direction::x ? -1 : -2);
    const auto [at, fresh] = places.emplace(std::tuple(a.story, place, a.is_force), a.name);
    if (!fresh) add("", "is at the same place as channel '" + at->second + "'");
  }
  const auto missing = [&](const std::string& what) {
    found.push_back({"", -1, "channels: no " + what});
  };
  for (const auto& [direction, name] : {std::pair(Direction::x, "x"), std::pair(Direction::y, "y")})
    if (above.contains(direction) && !base.contains(direction) &&
        (!has_force(axes) || !base.empty()))
      missing(std::string("base channel (story = 0) in direction ") + name);
  if (above.empty()) missing("channel above the base");
  return found;
}

std::vector<std::string> problems(const Structure& s, const std::vector<SensorAxis>& axes) {
  std::vector<std::string> messages;
  for (const Problem& problem : find_problems(s, axes)) messages.push_back(problem.message);
  return messages;
}

std::vector<std::uint8_t> identifying(const std::vector<SensorAxis>& axes) {
  std::vector<std::uint8_t> out;
  for (const SensorAxis& axis : axes) out.push_back(axis.check ? 0 : 1);
  return out;
}

std::vector<std::size_t> shaken_axes(const std::vector<SensorAxis>& axes) {
  std::vector<std::size_t> base, all;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (!axes[a].horizontal()) continue;
    all.push_back(a);
    if (axes[a].story == 0) base.push_back(a);
  }
  return base.empty() ? all : base;
}

Direction direction_of(const Structure& s, const SensorAxis& axis) {
  return axis.frame >= 0 ? s.direction(axis.frame) : axis.direction;
}

std::vector<double> noise_densities(const std::vector<SensorAxis>& axes) {
  std::vector<double> out;
  for (const SensorAxis& axis : axes)
    out.push_back(axis.noise_density > 0 ? axis.noise_density : kDefaultNoiseDensity);
  return out;
}

}  // namespace framewatch::estimator
