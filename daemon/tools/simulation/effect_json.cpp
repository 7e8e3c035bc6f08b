#include "daemon/tools/simulation/effect_json.h"

#include <nlohmann/json.hpp>

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

}  // namespace framewatch::daemon
