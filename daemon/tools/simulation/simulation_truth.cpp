// SPDX-License-Identifier: MIT
#include "daemon/tools/simulation/simulation_truth.h"

#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "daemon/config/channel_addresses.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {
namespace {

const char* kind_text(const estimator::EffectPlace& p,
                      const std::vector<estimator::SensorAxis>& axes) {
  switch (p.kind) {
    case estimator::PlaceKind::frame:
      return "frame";
    case estimator::PlaceKind::panel:
      return "panel";
    case estimator::PlaceKind::node:
    case estimator::PlaceKind::node_pair:
    case estimator::PlaceKind::crossing:
      return "node";
    case estimator::PlaceKind::floor:
      return "floor";
    case estimator::PlaceKind::building:
      return "building";
    case estimator::PlaceKind::whole_frame:
      return "whole_frame";
    case estimator::PlaceKind::mode:
      return "mode";
    case estimator::PlaceKind::channel:
    case estimator::PlaceKind::channel_pair:
      return axes[static_cast<std::size_t>(p.channel)].story > 0 ? "channel" : "base";
  }
  return "";
}

using Json = nlohmann::ordered_json;

Json frames(const estimator::Structure& s, const Eigen::VectorXd& theta, int first, int count,
            int offset) {
  const estimator::ParameterTable table(s);
  Json out = Json::array();
  for (int story = 1; story <= s.stories; ++story) {
    Json row = Json::array();
    for (int f = first; f < first + count; ++f)
      row.push_back(theta[table.frame_stiffness(story, f) + offset]);
    out.push_back(row);
  }
  return out;
}

/// Returns a grid [story][x span][y span].
Json panels(const estimator::Structure& s, const Eigen::VectorXd& theta, int offset) {
  const estimator::ParameterTable table(s);
  Json out = Json::array();
  for (int story = 1; s.panels() > 0 && story <= s.stories; ++story) {
    Json floor = Json::array();
    for (int x = 0; x < s.m() - 1; ++x) {
      Json row = Json::array();
      for (int y = 0; y < s.n() - 1; ++y)
        row.push_back(theta[table.panel_stiffness(story, y * (s.m() - 1) + x) + offset]);
      floor.push_back(row);
    }
    out.push_back(floor);
  }
  return out;
}

/// Returns a grid [story][x line][y line].
Json masses(const estimator::Structure& s) {
  const int rows = std::max(s.n(), 1);
  const int columns = std::max(s.m(), 1);
  Json out = Json::array();
  for (int story = 0; story < s.stories; ++story) {
    Json floor = Json::array();
    for (int x = 0; x < columns; ++x) {
      Json line = Json::array();
      for (int y = 0; y < rows; ++y)
        line.push_back(s.node_mass[static_cast<std::size_t>((story * rows + y) * columns + x)]);
      floor.push_back(line);
    }
    out.push_back(floor);
  }
  return out;
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
