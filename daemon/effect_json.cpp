#include "daemon/effect_json.h"

#include "estimator/structure/place_names.h"

namespace framewatch::daemon {
namespace {

const char* text(Direction direction) {
  return direction == Direction::x ? "x" : "y";
}

const char* kind_text(const EffectPlace& p, const std::vector<SensorAxis>& axes) {
  switch (p.kind) {
    case PlaceKind::frame:
      return "frame";
    case PlaceKind::panel:
      return "panel";
    case PlaceKind::node:
    case PlaceKind::node_pair:
    case PlaceKind::crossing:
      return "node";
    case PlaceKind::floor:
      return "floor";
    case PlaceKind::building:
      return "building";
    case PlaceKind::channel:
    case PlaceKind::channel_pair:
      return axes[static_cast<std::size_t>(p.channel)].story > 0 ? "channel" : "base";
  }
  return "";
}

}  // namespace

nlohmann::ordered_json location_json(const EffectPlace& p, const Structure& s,
                                     const std::vector<SensorAxis>& axes) {
  nlohmann::ordered_json out{{"kind", kind_text(p, axes)}};
  const auto add_channel = [&](const char* key, int channel) {
    out[key] = axes[static_cast<std::size_t>(channel)].name;
  };
  if (p.kind == PlaceKind::building) out["direction"] = text(p.direction);
  if (p.frame >= 0) out["direction"] = text(s.direction(p.frame));
  if (p.channel >= 0) out["direction"] = text(axes[static_cast<std::size_t>(p.channel)].direction);
  if (p.story > 0) out["story"] = p.story;
  if (p.frame >= 0) out["frame"] = s.frame_name(p.frame);
  if (p.panel >= 0) out["panel"] = panel_name(s, p.panel);
  if (p.crossing >= 0) out["node"] = crossing_name(s, p.crossing);
  if (p.kind == PlaceKind::node_pair) out["to_story"] = p.to_story;
  if (p.channel >= 0) add_channel("channel", p.channel);
  if (p.with_channel >= 0) add_channel("with_channel", p.with_channel);
  return out;
}

nlohmann::ordered_json parameters_json(const Effect& effect) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  const auto& parameters = describe(effect.kind).parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    out[std::string(parameters[i].key)] = {{"value", effect.values[i]},
                                           {"unit", std::string(parameters[i].unit)}};
  return out;
}

}  // namespace framewatch::daemon
