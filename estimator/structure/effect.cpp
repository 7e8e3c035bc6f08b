// SPDX-License-Identifier: MIT
#include "estimator/structure/effect.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <initializer_list>

#include "estimator/structure/matrices.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {
namespace {

std::size_t index_of(const Effect& effect, std::string_view key) {
  const auto& all = describe(effect.kind).parameters;
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const EffectParameter& p) { return p.key == key; });
  assert(at != all.end() && "the effect has this parameter");
  return static_cast<std::size_t>(at - all.begin());
}

}  // namespace

const EffectDescription& describe(EffectKind kind) {
  return effect_catalogue()[static_cast<std::size_t>(kind)];
}

std::string_view name_of(EffectKind kind) {
  return describe(kind).name;
}

std::optional<EffectKind> find_effect(std::string_view name) {
  for (const EffectDescription& d : effect_catalogue())
    if (d.name == name) return d.kind;
  return std::nullopt;
}

bool is_channel_effect(EffectKind kind) {
  const PlaceKind place = describe(kind).places.front();
  return place == PlaceKind::channel || place == PlaceKind::channel_pair;
}

double Effect::value(std::string_view key) const {
  return values[index_of(*this, key)];
}

void Effect::set(std::string_view key, double value) {
  values[index_of(*this, key)] = value;
}

Effect make_effect(EffectKind kind, const EffectPlace& place) {
  Effect out{kind, place, {}};
  for (const EffectParameter& p : describe(kind).parameters)
    out.values.push_back(p.default_value.value_or(0));
  return out;
}

namespace {

int x_lines(const Structure& s) {
  return std::max(s.m(), 1);
}

int crossings(const Structure& s) {
  return std::max(s.n(), 1) * x_lines(s);
}

/// Returns true if a rigid floor has at least one panel that could shear.
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

namespace {

std::string number_text(double value) {
  const bool whole = value == std::round(value);
  return whole ? std::to_string(static_cast<long long>(value)) : std::to_string(value);
}

/// Returns "must be > 0 and <= 2 s". Bounds that only reject absurd numbers are left out.
std::string range_text(const EffectParameter& p) {
  constexpr double kSane = 1e9;
  std::string out;
  if (p.min > -kSane) out = (p.above_min ? "> " : ">= ") + number_text(p.min);
  if (p.max < kSane) out += (out.empty() ? "<= " : " and <= ") + number_text(p.max);
  if (out.empty()) return "must be finite and below 1e15";
  return "must be " + out + (p.unit.empty() ? "" : " ") + std::string(p.unit);
}

class Checker {
 public:
  Checker(const Effect& effect, const Structure& structure, const std::vector<SensorAxis>& axes)
      : effect_(effect), place_(effect.place), s_(structure), axes_(axes) {}

  std::vector<Problem> run() {
    const EffectDescription& d = describe(effect_.kind);
    if (std::find(d.places.begin(), d.places.end(), place_.kind) == d.places.end()) {
      add("", "this effect cannot be at this kind of place");
      return found_;
    }
    check_place();
    check_values(d);
    if (found_.empty()) check_together();
    return found_;
  }

 private:
  void add(std::string_view field, const std::string& rule) {
    found_.push_back({std::string(field), -1,
                      std::string(name_of(effect_.kind)) + (field.empty() ? "" : ".") +
                          std::string(field) + ": " + rule});
  }

  static bool inside(int index, int count) { return index >= 0 && index < count; }

  void check_place() {
    const PlaceKind kind = place_.kind;
    const bool in_channels = kind == PlaceKind::channel || kind == PlaceKind::channel_pair;
    if (in_channels) {
      check_channels();
      return;
    }
    if (kind == PlaceKind::building) {
      if ((place_.direction == Direction::x ? s_.n() : s_.m()) == 0)
        add("direction", "the building has no frame in this direction");
      return;
    }
    if (kind == PlaceKind::whole_frame) {
      if (!inside(place_.frame, s_.frames())) add("frame", "no such frame");
      return;
    }
    if (kind == PlaceKind::mode) {
      const auto modes = static_cast<int>(floor_constraint(s_).cols());
      if (!inside(place_.mode - 1, modes)) add("mode", "must be 1 to " + std::to_string(modes));
      return;
    }
    if (place_.story < 1 || place_.story > s_.stories)
      add("story", "must be 1 to " + std::to_string(s_.stories));
    const bool on_frame =
        kind == PlaceKind::frame || kind == PlaceKind::node || kind == PlaceKind::node_pair;
    if (on_frame && !inside(place_.frame, s_.frames())) add("frame", "no such frame");
    if (kind == PlaceKind::panel && !inside(place_.panel, s_.panels()))
      add("panel", s_.panels() > 0 ? "no such panel" : "this building has no floor panels");
    if (kind == PlaceKind::crossing && !inside(place_.crossing, s_.nodes() / s_.stories))
      add("node", "no such node");
    if (kind == PlaceKind::node_pair && (place_.to_story < 0 || place_.to_story > place_.story - 2))
      add("to_story", "must be 0 to " + std::to_string(place_.story - 2) +
                          ": neighboring floors are already joined by their frame");
    if (kind == PlaceKind::floor && (s_.floor != FloorModel::rigid || s_.n() < 2 || s_.m() < 2))
      add("story", "only a building with floor = \"rigid\" and two frames each way at least");
  }

  void check_channels() {
    const int count = static_cast<int>(axes_.size());
    const bool one = inside(place_.channel, count);
    if (!one) add("channel", "no such channel");
    if (place_.kind == PlaceKind::channel) return;
    const bool other = inside(place_.with_channel, count);
    if (!other) add("with_channel", "no such channel");
    if (one && place_.channel == place_.with_channel)
      add("with_channel", "must be another channel");
  }

  void check_values(const EffectDescription& d) {
    if (effect_.values.size() != d.parameters.size()) {
      add("", "needs " + std::to_string(d.parameters.size()) + " values");
      return;
    }
    for (std::size_t i = 0; i < d.parameters.size(); ++i) {
      const EffectParameter& p = d.parameters[i];
      const double v = effect_.values[i];
      if (std::isfinite(v) && v <= p.max && (p.above_min ? v > p.min : v >= p.min)) continue;
      add(p.key, range_text(p));
    }
  }

  void check_zero(std::initializer_list<std::string_view> keys, std::string_view with) {
    for (const std::string_view key : keys)
      if (effect_.value(key) != 0) add(key, "must be 0 with " + std::string(with));
  }

  void check_yielding() {
    constexpr double kRoundest = 0.2;
    const double sharpness = effect_.value("sharpness");
    if (sharpness > 0 && sharpness < kRoundest) add("sharpness", "must be 0 or at least 0.2");
    if (sharpness > 0) check_zero({"spread", "strength_loss", "asymmetry"}, "sharpness");
    const bool oriented = effect_.value("peak_oriented") == 1;
    if (!oriented && effect_.value("peak_oriented") != 0) add("peak_oriented", "must be 0 or 1");
    if (!oriented && effect_.value("unloading") > 0)
      add("unloading", "must be 0 without peak_oriented");
    if (oriented)
      check_zero({"spread", "strength_loss", "sharpness", "asymmetry"}, "peak_oriented");
  }

  void check_together() {
    if (effect_.kind == EffectKind::one_sided_gap && std::abs(effect_.value("side")) != 1)
      add("side", "must be 1 or -1");
    if (effect_.kind == EffectKind::bilinear_hysteresis) check_yielding();
    if (effect_.kind == EffectKind::unmeasured_force &&
        effect_.value("low_hz") >= effect_.value("high_hz"))
      add("low_hz", "must be below high_hz");
    if (effect_.kind == EffectKind::amplitude_dependence && effect_.value("slip") > 0 &&
        effect_.value("softening") < 0)
      add("softening", "must not be below 0 where joints slip: their loops would gain energy");
    if (effect_.kind == EffectKind::extra_mass) {
      const auto node = static_cast<std::size_t>((place_.story - 1) * (s_.nodes() / s_.stories) +
                                                 place_.crossing);
      if (s_.node_mass[node] + effect_.value("mass_kg") <= 0)
        add("mass_kg", "leaves the node without mass");
    }
    if (effect_.kind == EffectKind::misalignment) {
      const SensorAxis& a = axes_[static_cast<std::size_t>(place_.channel)];
      const SensorAxis& b = axes_[static_cast<std::size_t>(place_.with_channel)];
      if (a.direction == b.direction || a.story != b.story)
        add("with_channel", "must be on the same floor, in the other direction");
    }
  }

  const Effect& effect_;
  const EffectPlace& place_;
  const Structure& s_;
  const std::vector<SensorAxis>& axes_;
  std::vector<Problem> found_;
};

}  // namespace

std::vector<Problem> find_problems(const Effect& effect, const Structure& structure,
                                   const std::vector<SensorAxis>& axes) {
  return Checker(effect, structure, axes).run();
}

}  // namespace framewatch::estimator
