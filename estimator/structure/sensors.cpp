#include "estimator/structure/sensors.h"

#include <cmath>
#include <map>
#include <set>
#include <tuple>

namespace framewatch {

std::vector<std::string> problems(const Structure& s, const std::vector<SensorAxis>& axes) {
  std::vector<std::string> found;
  std::set<std::string> names;
  std::map<std::tuple<int, int>, std::string> places;
  std::set<Direction> base;
  for (const SensorAxis& a : axes) {
    const std::string who = "channel '" + a.name + "': ";
    if (a.name.empty()) found.push_back("channel: needs a name");
    if (!names.insert(a.name).second) found.push_back(who + "named twice");
    if (a.story < 0 || a.story > s.stories) {
      found.push_back(who + "story " + std::to_string(a.story) + " does not exist, 0 (base) to " +
                      std::to_string(s.stories) + " do");
      continue;
    }
    if (a.frame >= s.frames() || (a.story > 0 && a.frame < 0)) {
      found.push_back(who + "its frame does not exist");
      continue;
    }
    if (!std::isfinite(a.scale) || a.scale == 0) found.push_back(who + "scale must not be 0");
    if (a.polarity != 1 && a.polarity != -1) found.push_back(who + "polarity must be 1 or -1");
    const int place = a.frame >= 0 ? a.frame : (a.direction == Direction::x ? -1 : -2);
    if (a.story == 0) base.insert(a.frame >= 0 ? s.direction(a.frame) : a.direction);
    const auto [at, fresh] = places.emplace(std::tuple(a.story, place), a.name);
    if (!fresh) found.push_back(who + "sits where channel '" + at->second + "' sits already");
  }
  if (s.n() > 0 && !base.contains(Direction::x))
    found.push_back("channels: no base channel (story = 0) in direction x");
  if (s.m() > 0 && !base.contains(Direction::y))
    found.push_back("channels: no base channel (story = 0) in direction y");
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f)
      if (!places.contains(std::tuple(story, f)))
        found.push_back("channels: no channel on story " + std::to_string(story) + ", frame '" +
                        s.frame_name(f) + "'");
  return found;
}

}  // namespace framewatch
