#include <algorithm>

#include "estimator/structure/effect.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/place_names.h"

namespace framewatch::estimator {
namespace {

int x_lines(const Structure& s) {
  return std::max(s.m(), 1);
}

int crossings(const Structure& s) {
  return std::max(s.n(), 1) * x_lines(s);
}

/// Whether a floor assumed rigid could have panels.
bool could_flex(const Structure& s) {
  return s.floor == FloorModel::rigid && s.n() > 1 && s.m() > 1;
}

void add_places(PlaceKind kind, const Structure& s, const std::vector<SensorAxis>& axes,
                std::vector<EffectPlace>& out) {
  EffectPlace place;
  place.kind = kind;
  const auto add_each = [&](int& member, int count) {
    for (member = 0; member < count; ++member) out.push_back(place);
    member = -1;
  };
  switch (kind) {
    case PlaceKind::frame:
    case PlaceKind::node:
      for (place.story = 1; place.story <= s.stories; ++place.story)
        add_each(place.frame, s.frames());
      return;
    case PlaceKind::panel:
      for (place.story = 1; place.story <= s.stories; ++place.story)
        add_each(place.panel, s.panels());
      return;
    case PlaceKind::crossing:
      for (place.story = 1; place.story <= s.stories; ++place.story)
        add_each(place.crossing, crossings(s));
      return;
    case PlaceKind::node_pair:
      for (place.story = 2; place.story <= s.stories; ++place.story)
        for (place.to_story = 0; place.to_story <= place.story - 2; ++place.to_story)
          add_each(place.frame, s.frames());
      return;
    case PlaceKind::floor:
      for (place.story = 1; could_flex(s) && place.story <= s.stories; ++place.story)
        out.push_back(place);
      return;
    case PlaceKind::building:
      for (const Direction direction : {Direction::x, Direction::y}) {
        place.direction = direction;
        if ((direction == Direction::x ? s.n() : s.m()) > 0) out.push_back(place);
      }
      return;
    case PlaceKind::whole_frame:
      if (s.stories > 1) add_each(place.frame, s.frames());
      return;
    case PlaceKind::mode: {
      const auto modes = static_cast<int>(floor_constraint(s).cols());
      for (place.mode = 1; place.mode <= modes; ++place.mode) out.push_back(place);
      return;
    }
    case PlaceKind::channel:
      add_each(place.channel, static_cast<int>(axes.size()));
      return;
    case PlaceKind::channel_pair: {
      const int count = static_cast<int>(axes.size());
      for (place.channel = 0; place.channel < count; ++place.channel)
        for (place.with_channel = 0; place.with_channel < count; ++place.with_channel)
          if (place.channel != place.with_channel) out.push_back(place);
      return;
    }
  }
}

std::string channel_name(const std::vector<SensorAxis>& axes, int channel) {
  return axes[static_cast<std::size_t>(channel)].name;
}

}  // namespace

std::vector<EffectPlace> effect_places(EffectKind kind, const Structure& s,
                                       const std::vector<SensorAxis>& axes) {
  std::vector<EffectPlace> out;
  for (const PlaceKind place : describe(kind).places) add_places(place, s, axes, out);
  if (kind == EffectKind::swapped)
    std::erase_if(out, [](const EffectPlace& p) { return p.channel > p.with_channel; });
  if (kind == EffectKind::misalignment)
    std::erase_if(out, [&](const EffectPlace& p) {
      const SensorAxis& a = axes[static_cast<std::size_t>(p.channel)];
      const SensorAxis& b = axes[static_cast<std::size_t>(p.with_channel)];
      return a.story != b.story || a.direction == b.direction;
    });
  return out;
}

std::string place_text(const EffectPlace& p, const Structure& s,
                       const std::vector<SensorAxis>& axes) {
  const std::string story = std::to_string(p.story);
  switch (p.kind) {
    case PlaceKind::frame:
      return "story " + story + ", frame " + s.frame_name(p.frame);
    case PlaceKind::panel:
      return "floor " + story + ", panel " + panel_name(s, p.panel);
    case PlaceKind::node:
      return "floor " + story + ", frame " + s.frame_name(p.frame);
    case PlaceKind::node_pair:
      return "frame " + s.frame_name(p.frame) + ", floors " + std::to_string(p.to_story) + " to " +
             story;
    case PlaceKind::crossing:
      return "floor " + story + ", node " + crossing_name(s, p.crossing);
    case PlaceKind::floor:
      return "floor " + story;
    case PlaceKind::building:
      return p.direction == Direction::x ? "building along x" : "building along y";
    case PlaceKind::whole_frame:
      return "frame " + s.frame_name(p.frame) + ", all stories";
    case PlaceKind::mode:
      return "mode " + std::to_string(p.mode);
    case PlaceKind::channel:
      return "channel " + channel_name(axes, p.channel);
    case PlaceKind::channel_pair:
      return "channel " + channel_name(axes, p.channel) + " with " +
             channel_name(axes, p.with_channel);
  }
  return "";
}

}  // namespace framewatch::estimator
