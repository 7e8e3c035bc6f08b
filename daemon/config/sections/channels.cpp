// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "daemon/config/keys/section.h"
#include "daemon/config/keys/suggest.h"
#include "daemon/config/keys/target.h"
#include "daemon/config/sections/sections.h"
#include "estimator/identify/groups/floor_coordinates.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::daemon {
namespace {

using Channels = std::vector<ConfigSection>;

/// Marks a frame that does not exist; find_problems() skips its place.
constexpr int kNoFrame = -2;

int frame_of(ConfigSection& section, const StructureReading& reading) {
  const estimator::Structure& s = reading.structure;
  const std::string name = section.text("frame");
  std::vector<std::string> names;
  for (int f = 0; f < s.frames(); ++f) {
    names.push_back(s.frame_name(f));
    if (names.back() == name) return f;
  }
  section.problem("frame", fmt::format("no frame is named \"{}\"{}; the frames are {}", name,
                                       did_you_mean(name, names, "\""), fmt::join(names, ", ")));
  return kNoFrame;
}

/// Returns the middle of the frames that are parallel to the other direction, m.
double middle_m(const estimator::Structure& s, estimator::Direction along) {
  const bool x = along == estimator::Direction::x;
  const int last = x ? s.frames() - 1 : s.n() - 1;
  return (x ? s.m() : s.n()) > 0 ? line_position(s, last) / 2 : 0;
}

/// Reads the place in plan and the direction of the axis into axis.plan. Leaves it empty for a base
/// channel of the whole plan.
void read_plan(ConfigSection& section, const StructureReading& reading,
               estimator::SensorAxis& axis) {
  const bool azimuth = section.given("azimuth_deg");
  if (azimuth && !reading.azimuth_y_deg)
    section.problem("azimuth_deg", "needs the building's own: [structure] azimuth_y_deg");
  if (azimuth && section.given("direction"))
    section.problem("azimuth_deg", "a channel has a direction or an azimuth");
  const bool at_place = section.given("x_m") || section.given("y_m") || azimuth;
  if ((axis.story == 0 && !at_place) || !reading.frames_known) return;
  estimator::PlanPlace place;
  const estimator::Structure& s = reading.structure;
  place.x_m = section.given("x_m") ? section.number("x_m") : middle_m(s, estimator::Direction::x);
  place.y_m = section.given("y_m") ? section.number("y_m") : middle_m(s, estimator::Direction::y);
  place.angle_rad = axis.direction == estimator::Direction::y ? M_PI / 2 : 0;
  if (azimuth && reading.azimuth_y_deg)
    place.angle_rad = std::remainder(
        M_PI / 2 - radians(section.number("azimuth_deg") - *reading.azimuth_y_deg), 2 * M_PI);
  if (azimuth)
    axis.direction = std::abs(std::cos(place.angle_rad)) >= std::abs(std::sin(place.angle_rad))
                         ? estimator::Direction::x
                         : estimator::Direction::y;
  axis.plan = place;
}

/// Reads story, frame, direction and place, and checks the rules between them.
void read_place(ConfigSection& section, const StructureReading& reading,
                estimator::SensorAxis& axis) {
  const bool names_frame = section.value("frame") != nullptr;
  if (section.good("story")) axis.story = section.integer("story");
  if (section.good("story") && !names_frame && !section.value("direction") &&
      !section.value("azimuth_deg"))
    section.problem(axis.story > 0 ? "frame" : "direction",
                    axis.story > 0
                        ? "is missing: above the base a channel rides on a frame, or has a "
                          "direction or an azimuth, and a place x_m, y_m"
                        : "is missing: a base channel needs direction = \"x\" or \"y\"");
  if (section.given("direction"))
    axis.direction =
        section.text("direction") == "y" ? estimator::Direction::y : estimator::Direction::x;
  if (!names_frame) return read_plan(section, reading, axis);
  for (const char* key : {"x_m", "y_m", "azimuth_deg"})
    if (section.given(key))
      section.problem(key, "not allowed with frame: the channel's place is the frame's");
  axis.frame =
      section.given("frame") && reading.frames_known ? frame_of(section, reading) : kNoFrame;
  if (axis.frame == kNoFrame) return;
  const estimator::Direction along = reading.structure.direction(axis.frame);
  if (section.given("direction") && axis.direction != along)
    section.problem("direction",
                    fmt::format("frame {} moves along {}", section.text("frame"), letter(along)));
  axis.direction = along;
}

AxisSource read_source(ConfigSection& channel, const std::string& label,
                       std::vector<TextProblem>& problems) {
  if (!channel.given("source")) return {};
  const TomlValue* table = channel.value("source");
  if (table->find("can") || table->find("dbc_signal")) {
    ConfigSection section("channel.source.can", label + ".source", table, {}, problems);
    if (!section.good("can") || !section.good("dbc_signal")) return {};
    return section.read<AxisSource>();
  }
  ConfigSection section("channel.source", label + ".source", table, {}, problems);
  auto source = section.read<AxisSource>();
  if (source.lcm_channel.empty() || source.lcm_channel.size() > 63)
    section.problem("lcm", "an LCM channel's name has 1 to 63 characters");
  if (!section.good("node") || !section.good("axis") || !section.good("lcm"))
    source.sensor_node = -1;
  return source;
}

/// Returns a name for what sends a source's samples; "" if they come from files only.
std::string node_of(const AxisSource& source) {
  if (!source.dbc_signal.empty())
    return fmt::format("{} {}", source.can,
                       source.dbc_signal.substr(0, source.dbc_signal.find('.')));
  return source.sensor_node < 0 ? "" : fmt::format("{} {}", source.lcm_channel, source.sensor_node);
}

/// Reads the keys of a force in N, or refuses them for an accelerometer.
void read_quantity(ConfigSection& section, estimator::SensorAxis& axis) {
  axis.is_force = section.given("quantity") && section.text("quantity") == "force";
  const auto refuse = [&](std::initializer_list<const char*> keys, const char* rule) {
    for (const char* key : keys)
      if (section.given(key)) section.problem(key, rule);
  };
  if (!axis.is_force)
    return refuse({"offset_n", "range_n", "noise_n_per_rthz"},
                  "is a key of forces: set quantity = \"force\"");
  refuse({"offset_mps2", "range_mps2", "noise_mps2_per_rthz"},
         "a force is in N: offset_n, range_n, noise_n_per_rthz");
  refuse({"tilt_deg", "mount_angle_deg", "cross_channel"}, "is a key of accelerometers");
  if (section.given("offset_n")) axis.offset = section.number("offset_n");
  if (section.given("range_n")) axis.range = section.number("range_n");
  if (section.given("noise_n_per_rthz")) axis.noise_density = section.number("noise_n_per_rthz");
}

std::string label_of(const TomlValue& table) {
  const TomlEntry* name = table.find("name");
  const bool named = name && name->value.kind == TomlKind::text && !name->value.text.empty();
  return named ? fmt::format("channel '{}'", name->value.text) : "channel";
}

void read_channel(const TomlValue& table, const StructureReading& reading, Config& config,
                  Channels& channels, std::vector<TextProblem>& problems) {
  const std::string label = label_of(table);
  ConfigSection section("channel", label, &table, {}, problems);
  auto axis = section.read<estimator::SensorAxis>();
  if (section.given("name"))
    if (const std::string rule = problem_of_name(axis.name); !rule.empty())
      section.problem("name", rule);
  axis.vertical = section.given("direction") && section.text("direction") == "z";
  const auto leave = [&](const char* why) { config.unused.push_back({axis.name, why}); };
  if (section.given("use") && !section.boolean("use")) return leave("use = false");
  if (axis.vertical) {
    if (section.good("story")) axis.story = section.integer("story");
    if (axis.story > 0) return leave("it measures vertical motion above the base");
    if (!section.given("x_m") || !section.given("y_m"))
      return leave("it measures vertical motion and has no place in plan (x_m, y_m)");
    axis.plan = estimator::PlanPlace{section.number("x_m"), section.number("y_m"), 0};
  } else {
    read_quantity(section, axis);
    read_place(section, reading, axis);
  }
  config.sources.push_back(read_source(section, label, problems));
  if (axis.group.empty()) axis.group = node_of(config.sources.back());
  config.pipeline.axes.push_back(axis);
  channels.push_back(std::move(section));
}

/// Leaves out vertical channels that do not show how the base rocks. Leaves out all of them if
/// floor panels are identified, because only groups of stories include rocking.
void leave_idle_verticals(const StructureReading& reading, Config& config, Channels& channels) {
  std::vector<estimator::SensorAxis>& axes = config.pipeline.axes;
  const std::vector<std::uint8_t> all(axes.size(), 1);
  const auto rotations = base_rotations(axes, all);
  const bool shown = rotations[0].size() > 0 || rotations[1].size() > 0;
  const bool panels = reading.structure.panels() > 0 && reading.frames_known &&
                      reading.stories_known && find_problems(reading.structure, axes).empty() &&
                      story_groups(reading.structure, horizontals(axes)).every_story;
  if (shown && !panels) return;
  for (std::size_t a = axes.size(); a-- > 0;) {
    if (!axes[a].vertical) continue;
    config.unused.push_back(
        {axes[a].name,
         panels ? "it measures vertical motion, but with floor panels rocking is not identified"
                : "it measures vertical motion: rocking needs three such channels that are not in "
                  "line, or two along x or y"});
    const auto at = static_cast<std::ptrdiff_t>(a);
    axes.erase(axes.begin() + at);
    config.sources.erase(config.sources.begin() + at);
    channels.erase(channels.begin() + at);
  }
}

/// Resolves the names of cross channels, after all channels are read.
void find_cross_channels(Config& config, Channels& channels) {
  std::vector<estimator::SensorAxis>& axes = config.pipeline.axes;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    if (!channels[i].given("cross_channel")) continue;
    const std::string name = channels[i].text("cross_channel");
    std::vector<std::string> names;
    for (std::size_t b = 0; b < axes.size(); ++b) {
      names.push_back(axes[b].name);
      if (axes[b].name == name) axes[i].cross = static_cast<int>(b);
    }
    if (axes[i].cross >= 0) continue;
    channels[i].problem("cross_channel", fmt::format("no channel is named \"{}\"{}", name,
                                                     did_you_mean(name, names, "\"")));
  }
}

void check_sources(const Config& config, Channels& channels) {
  std::map<std::tuple<std::string, int, int>, std::string> taken;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const AxisSource& s = config.sources[i];
    if (s.sensor_node < 0) continue;
    const auto [at, fresh] = taken.emplace(std::tuple(s.lcm_channel, s.sensor_node, s.axis),
                                           config.pipeline.axes[i].name);
    if (!fresh)
      channels[i].problem(
          "source", fmt::format("axis {} of node {} on {} is the source of channel '{}' already",
                                "xyz"[s.axis], s.sensor_node, s.lcm_channel, at->second));
  }
}

/// Reports the problems of find_problems() at their channels' lines, except those already reported.
void check_against_structure(const StructureReading& reading, const Config& config,
                             TextPlace where_missing, Channels& channels,
                             std::vector<TextProblem>& problems) {
  const std::vector<estimator::SensorAxis>& axes = config.pipeline.axes;
  const bool places_known = reading.stories_known && reading.frames_known;
  const auto unplaced = [&](const ConfigSection& channel) {
    return !channel.good("story") || !channel.good("frame") || !channel.good("direction");
  };
  for (const estimator::Problem& p : find_problems(reading.structure, axes)) {
    if (p.index < 0) {
      if (places_known) problems.push_back({where_missing, p.message});
      continue;
    }
    ConfigSection& channel = channels[static_cast<std::size_t>(p.index)];
    const bool about_place = p.field.empty() || p.field == "story" || p.field == "frame";
    if (about_place && (!places_known || unplaced(channel))) continue;
    if (p.field == "story" && !reading.stories_known) continue;
    if (!p.field.empty() && !channel.good(p.field)) continue;
    const std::size_t rule = p.message.find("': ");
    channel.problem(p.field, p.message.substr(rule == std::string::npos ? 0 : rule + 3));
  }
}

}  // namespace

void read_channels(const TomlValue& document, const StructureReading& reading, Config& config,
                   std::vector<TextProblem>& problems) {
  const TomlEntry* entry = document.find("channel");
  TextPlace where{1, 1};
  Channels channels;
  if (entry) {
    where = entry->place;
    if (entry->value.kind != TomlKind::array) {
      problems.push_back({where, "channel: write [[channel]] above each one"});
      return;
    }
    for (const TomlValue& table : entry->value.items)
      read_channel(table, reading, config, channels, problems);
  }
  leave_idle_verticals(reading, config, channels);
  find_cross_channels(config, channels);
  check_sources(config, channels);
  check_against_structure(reading, config, where, channels, problems);
}

}  // namespace framewatch::daemon
