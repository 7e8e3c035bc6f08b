// SPDX-License-Identifier: MIT
#include "daemon/tools/simulation/simulation_truth.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "daemon/config/channel_addresses.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {
namespace {

/// Kinds of estimator::PlaceKind, in its order. A channel of the base is of kind "base".
constexpr std::array kKinds = {"frame",    "panel",       "node", "node",    "node",   "floor",
                               "building", "whole_frame", "mode", "channel", "channel"};
static_assert(kKinds.size() == static_cast<std::size_t>(estimator::PlaceKind::channel_pair) + 1);

const char* kind_text(const estimator::EffectPlace& p,
                      const std::vector<estimator::SensorAxis>& axes) {
  const bool base = p.channel >= 0 && axes[static_cast<std::size_t>(p.channel)].story <= 0;
  return base ? "base" : kKinds[static_cast<std::size_t>(p.kind)];
}

using Json = nlohmann::ordered_json;

/// Returns [of(0), of(1), ...] of `count` items.
template <typename Of>
Json list(int count, const Of& of) {
  Json out = Json::array();
  for (int i = 0; i < count; ++i) out.push_back(of(i));
  return out;
}

Json frames(const estimator::Structure& s, const Eigen::VectorXd& theta, int first, int count,
            int offset) {
  const estimator::ParameterTable table(s);
  return list(s.stories, [&](int story) {
    return list(count,
                [&](int f) { return theta[table.frame_stiffness(story + 1, first + f) + offset]; });
  });
}

/// Returns a grid [story][x span][y span].
Json panels(const estimator::Structure& s, const Eigen::VectorXd& theta, int offset) {
  const estimator::ParameterTable table(s);
  return list(s.panels() > 0 ? s.stories : 0, [&](int story) {
    return list(s.m() - 1, [&](int x) {
      return list(s.n() - 1, [&](int y) {
        return theta[table.panel_stiffness(story + 1, y * (s.m() - 1) + x) + offset];
      });
    });
  });
}

/// Returns a grid [story][x line][y line].
Json masses(const estimator::Structure& s) {
  const int rows = std::max(s.n(), 1), columns = std::max(s.m(), 1);
  return list(s.stories, [&](int story) {
    return list(columns, [&](int x) {
      return list(rows, [&](int y) {
        return s.node_mass[static_cast<std::size_t>((story * rows + y) * columns + x)];
      });
    });
  });
}

Json true_parameters(const Scenario& scenario) {
  const estimator::Structure& s = scenario.config.pipeline.structure;
  const int offset = estimator::ParameterTable(s).elements();
  return {{"N", s.stories},
          {"n", s.n()},
          {"m", s.m()},
          {"spans_x", s.span_x},
          {"spans_y", s.span_y},
          {"heights", s.story_height},
          {"node_mass", masses(s)},
          {"kx", frames(s, scenario.truth, 0, s.n(), 0)},
          {"ky", frames(s, scenario.truth, s.n(), s.m(), 0)},
          {"G", panels(s, scenario.truth, 0)},
          {"cx", frames(s, scenario.truth, 0, s.n(), offset)},
          {"cy", frames(s, scenario.truth, s.n(), s.m(), offset)},
          {"Gc", panels(s, scenario.truth, offset)},
          {"index_order",
           "kx[story][y line], ky[story][x line], G[story][x span][y span], "
           "node_mass[story][x line][y line]"}};
}

/// Returns the sensor at the place of the effect, if any.
std::string nearest_channel(const estimator::EffectPlace& p,
                            const std::vector<estimator::SensorAxis>& axes) {
  for (const estimator::SensorAxis& axis : axes)
    if (p.frame >= 0 && axis.story == p.story && axis.frame == p.frame) return axis.name;
  return "";
}

Json effect_json(const estimator::Effect& e, const Scenario& scenario) {
  const estimator::PipelineConfig& p = scenario.config.pipeline;
  Json location = location_json(e.place, p.structure, p.axes);
  if (location.contains("frame")) location["line"] = location["frame"];
  const std::string channel = nearest_channel(e.place, p.axes);
  if (!channel.empty()) location["channel"] = channel;
  return {{"effect", std::string(name_of(e.kind))},
          {"location", location},
          {"parameters", parameters_json(e)},
          {"law", std::string(describe(e.kind).equation)}};
}

}  // namespace

nlohmann::ordered_json location_json(const estimator::EffectPlace& p, const estimator::Structure& s,
                                     const std::vector<estimator::SensorAxis>& axes) {
  nlohmann::ordered_json out{{"kind", kind_text(p, axes)}};
  const auto add_channel = [&](const char* key, int channel) {
    out[key] = axes[static_cast<std::size_t>(channel)].name;
  };
  if (p.kind == estimator::PlaceKind::building) out["direction"] = letter(p.direction);
  if (p.frame >= 0) out["direction"] = letter(s.direction(p.frame));
  if (p.channel >= 0) out["direction"] = letter(axes[static_cast<std::size_t>(p.channel)]);
  if (p.story > 0) out["story"] = p.story;
  if (p.frame >= 0) out["frame"] = s.frame_name(p.frame);
  if (p.panel >= 0) out["panel"] = panel_name(s, p.panel);
  if (p.crossing >= 0) out["node"] = crossing_name(s, p.crossing);
  if (p.kind == estimator::PlaceKind::node_pair) out["to_story"] = p.to_story;
  if (p.mode > 0) out["mode"] = p.mode;
  if (p.channel >= 0) add_channel("channel", p.channel);
  if (p.with_channel >= 0) add_channel("with_channel", p.with_channel);
  return out;
}

nlohmann::ordered_json parameters_json(const estimator::Effect& effect) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  const auto& parameters = describe(effect.kind).parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    out[std::string(parameters[i].key)] = {{"value", effect.values[i]},
                                           {"unit", std::string(parameters[i].unit)}};
  return out;
}

std::string truth_json(const Scenario& s) {
  Json effects = Json::array();
  Json faults = Json::array();
  for (const estimator::Effect& e : s.effects) {
    effects.push_back(effect_json(e, s));
    if (is_channel_effect(e.kind)) faults.push_back(effects.back());
  }
  const Json out{{"case", std::filesystem::path(s.config.path).stem().string()},
                 {"seed", s.seed},
                 {"hidden", effects.empty() ? Json{{"effect", "none"}} : effects.front()},
                 {"effects", effects},
                 {"true_parameters", true_parameters(s)},
                 {"sensors", {{"faults", faults}, {"order", axis_names(s.config)}}}};
  return out.dump(1) + "\n";
}

}  // namespace framewatch::daemon
