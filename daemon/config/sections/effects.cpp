// SPDX-License-Identifier: MIT
#include "daemon/config/sections/effects.h"

#include <algorithm>
#include <functional>
#include <optional>
#include <set>

#include <fmt/format.h>

#include "daemon/config/keys/section.h"
#include "daemon/config/keys/suggest.h"
#include "estimator/structure/structure.h"

namespace framewatch::daemon {
namespace {

std::vector<std::string_view> place_keys(estimator::PlaceKind kind) {
  switch (kind) {
    case estimator::PlaceKind::frame:
    case estimator::PlaceKind::node:
      return {"story", "frame", "direction"};
    case estimator::PlaceKind::panel:
      return {"story", "panel"};
    case estimator::PlaceKind::node_pair:
      return {"story", "to_story", "frame", "direction"};
    case estimator::PlaceKind::crossing:
      return {"story", "node"};
    case estimator::PlaceKind::floor:
      return {"story"};
    case estimator::PlaceKind::building:
      return {"direction"};
    case estimator::PlaceKind::whole_frame:
      return {"frame", "direction"};
    case estimator::PlaceKind::mode:
      return {"mode"};
    case estimator::PlaceKind::channel:
      return {"channel"};
    case estimator::PlaceKind::channel_pair:
      return {"channel", "with_channel"};
  }
  return {};
}

class EffectReader {
 public:
  EffectReader(const TomlValue& table, const estimator::Structure& structure,
               const std::vector<estimator::SensorAxis>& axes, std::vector<TextProblem>& problems)
      : structure_(structure),
        axes_(axes),
        problems_(problems),
        section_("effect", label(table), &table, {}, problems),
        table_(table) {}

  std::optional<estimator::Effect> read() {
    const std::size_t before = problems_.size();
    const std::optional<estimator::EffectKind> kind = estimator::find_effect(section_.text("kind"));
    if (!kind || !section_.good("kind")) return std::nullopt;
    const estimator::EffectDescription& description = describe(*kind);
    estimator::EffectPlace place;
    place.kind = place_kind(description);
    refuse_other_keys(description, place.kind);
    read_place(place);
    estimator::Effect effect = make_effect(*kind, place);
    for (const estimator::EffectParameter& p : description.parameters) {
      if (section_.given(p.key))
        effect.set(p.key, section_.number(p.key));
      else if (!p.default_value && !section_.value(p.key))
        section_.problem(p.key, fmt::format("is missing, it has no default: {}", p.meaning));
    }
    for (const estimator::Problem& p : find_problems(effect, structure_, axes_)) {
      if (!p.field.empty() && !section_.good(p.field)) continue;
      if (p.field.empty() && problems_.size() > before) continue;
      const std::size_t rule = p.message.find(": ");
      section_.problem(p.field, p.message.substr(rule + 2));
    }
    if (problems_.size() > before || !section_.good()) return std::nullopt;
    return effect;
  }

 private:
  static std::string label(const TomlValue& table) {
    const TomlEntry* kind = table.kind == TomlKind::table ? table.find("kind") : nullptr;
    const bool named = kind && kind->value.kind == TomlKind::text;
    return named ? fmt::format("effect '{}'", kind->value.text) : "effect";
  }

  estimator::PlaceKind place_kind(const estimator::EffectDescription& d) const {
    using enum estimator::PlaceKind;
    const auto can_be = [&](estimator::PlaceKind kind) {
      return std::find(d.places.begin(), d.places.end(), kind) != d.places.end();
    };
    if (can_be(panel) && section_.value("panel") && !section_.value("frame")) return panel;
    if (can_be(node_pair) && section_.value("to_story")) return node_pair;
    if (can_be(whole_frame) && section_.value("frame")) return whole_frame;
    return d.places.front();
  }

  void refuse_other_keys(const estimator::EffectDescription& d, estimator::PlaceKind place) {
    std::vector<std::string> known;
    for (const std::string_view key : place_keys(place)) known.emplace_back(key);
    for (const estimator::EffectParameter& p : d.parameters) known.emplace_back(p.key);
    for (const TomlEntry& e : table_.entries) {
      if (e.key == "kind" || !find_option("effect", e.key)) continue;
      if (std::find(known.begin(), known.end(), e.key) == known.end())
        section_.problem(e.key, fmt::format("no key of {}; its keys are kind, {}", d.name,
                                            fmt::join(known, ", ")));
    }
  }

  void read_place(estimator::EffectPlace& place) {
    const auto keys = place_keys(place.kind);
    const auto wanted = [&](std::string_view key) {
      return std::find(keys.begin(), keys.end(), key) != keys.end();
    };
    if (wanted("story")) {
      if (section_.given("story")) place.story = section_.integer("story");
      require("story");
    }
    if (wanted("to_story") && section_.given("to_story"))
      place.to_story = section_.integer("to_story");
    if (wanted("frame"))
      place.frame =
          named("frame", structure_.frames(), [&](int f) { return structure_.frame_name(f); });
    if (wanted("panel"))
      place.panel =
          named("panel", structure_.panels(), [&](int p) { return panel_name(structure_, p); });
    if (wanted("node"))
      place.crossing = named("node", structure_.nodes() / structure_.stories,
                             [&](int c) { return crossing_name(structure_, c); });
    if (wanted("mode")) {
      if (section_.given("mode")) place.mode = section_.integer("mode");
      require("mode");
    }
    if (wanted("channel")) place.channel = channel("channel");
    if (wanted("with_channel")) place.with_channel = channel("with_channel");
    if (wanted("direction")) read_direction(place);
  }

  void read_direction(estimator::EffectPlace& place) {
    const bool building = place.kind == estimator::PlaceKind::building;
    if (building) require("direction");
    if (!section_.given("direction")) return;
    const estimator::Direction direction =
        section_.text("direction") == "y" ? estimator::Direction::y : estimator::Direction::x;
    if (building)
      place.direction = direction;
    else if (place.frame >= 0 && structure_.direction(place.frame) != direction)
      section_.problem("direction", fmt::format("frame {} moves along {}", section_.text("frame"),
                                                direction == estimator::Direction::x ? "y" : "x"));
  }

  int channel(std::string_view key) {
    return named(key, static_cast<int>(axes_.size()),
                 [&](int a) { return axes_[static_cast<std::size_t>(a)].name; });
  }

  void require(std::string_view key) {
    if (!section_.value(key)) section_.problem(key, "is missing");
  }

  int named(std::string_view key, int count, const std::function<std::string(int)>& name) {
    require(key);
    if (!section_.given(key)) return -1;
    const std::string wanted = section_.text(key);
    std::vector<std::string> names;
    for (int i = 0; i < count; ++i) {
      names.push_back(name(i));
      if (names.back() == wanted) return i;
    }
    section_.problem(
        key, count == 0 ? fmt::format("this building has no {}", key)
                        : fmt::format("none is named \"{}\"{}; there are {}", wanted,
                                      did_you_mean(wanted, names, "\""), fmt::join(names, ", ")));
    return -1;
  }

  const estimator::Structure& structure_;
  const std::vector<estimator::SensorAxis>& axes_;
  std::vector<TextProblem>& problems_;
  ConfigSection section_;
  const TomlValue& table_;
};

std::string place_toml(const estimator::EffectPlace& p, const estimator::Structure& s,
                       const std::vector<estimator::SensorAxis>& axes) {
  std::string out;
  for (const std::string_view key : place_keys(p.kind)) {
    if (key == "story") out += fmt::format("story = {}\n", p.story);
    if (key == "to_story") out += fmt::format("to_story = {}\n", p.to_story);
    if (key == "frame") out += fmt::format("frame = \"{}\"\n", s.frame_name(p.frame));
    if (key == "panel") out += fmt::format("panel = \"{}\"\n", panel_name(s, p.panel));
    if (key == "node") out += fmt::format("node = \"{}\"\n", crossing_name(s, p.crossing));
    if (key == "direction") {
      const estimator::Direction along =
          p.kind == estimator::PlaceKind::building ? p.direction : s.direction(p.frame);
      out += fmt::format("direction = \"{}\"\n", letter(along));
    }
    if (key == "mode") out += fmt::format("mode = {}\n", p.mode);
    if (key == "channel")
      out += fmt::format("channel = \"{}\"\n", axes[static_cast<std::size_t>(p.channel)].name);
    if (key == "with_channel")
      out += fmt::format("with_channel = \"{}\"\n",
                         axes[static_cast<std::size_t>(p.with_channel)].name);
  }
  return out;
}

}  // namespace

std::vector<estimator::Effect> read_effects(const std::vector<const TomlValue*>& tables,
                                            const estimator::Structure& structure,
                                            const std::vector<estimator::SensorAxis>& axes,
                                            std::vector<TextProblem>& problems) {
  std::vector<estimator::Effect> out;
  for (const TomlValue* table : tables)
    if (const auto effect = EffectReader(*table, structure, axes, problems).read())
      out.push_back(*effect);
  return out;
}

std::string effects_toml(const std::vector<estimator::Effect>& effects,
                         const estimator::Structure& structure,
                         const std::vector<estimator::SensorAxis>& axes) {
  std::string out;
  for (const estimator::Effect& e : effects) {
    out += fmt::format("{}[[effect]]\nkind = \"{}\"\n", out.empty() ? "" : "\n", name_of(e.kind));
    out += place_toml(e.place, structure, axes);
    const auto& parameters = describe(e.kind).parameters;
    for (std::size_t i = 0; i < parameters.size(); ++i)
      out += fmt::format("{} = {}\n", parameters[i].key, e.values[i]);
  }
  return out;
}

}  // namespace framewatch::daemon
