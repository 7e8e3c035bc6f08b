#include "estimator/structure/effect.h"

#include <algorithm>
#include <cassert>
#include <cmath>

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

}  // namespace framewatch::estimator
