// SPDX-License-Identifier: MIT
#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "daemon/config/keys/option_table.h"
#include "estimator/structure/effect.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;

const Option kPlaces[] = {
    {.key = "kind", .type = choice, .required = true, .meaning = "Kind of effect."},
    {.key = "story",
     .type = integer,
     .range = {1, 1000},
     .meaning = "Story of the frame story, panel, node or floor."},
    {.key = "frame", .type = text, .meaning = "Name of the frame."},
    {.key = "panel",
     .type = text,
     .meaning = "Floor panel, named after the frames where its spans start: \"x1y1\"."},
    {.key = "node",
     .type = text,
     .meaning = "Crossing of a y-parallel and an x-parallel frame: \"x1y1\"."},
    {.key = "to_story",
     .type = integer,
     .default_value = "0",
     .range = {0, 1000},
     .meaning = "Lower floor of two; 0 is the base."},
    {.key = "direction",
     .choices = "x|y",
     .meaning = "Direction, for effects of the whole building."},
    {.key = "mode",
     .type = integer,
     .range = {1, 100000},
     .meaning = "Mode, in the order of natural frequencies."},
    {.key = "channel", .type = text, .meaning = "Name of the channel."},
    {.key = "with_channel", .type = text, .meaning = "Name of the other channel."},
};

std::string names_of_effects() {
  std::string names;
  for (const estimator::EffectDescription& d : estimator::effect_catalogue())
    names += (names.empty() ? "" : "|") + std::string(d.name);
  return names;
}

/// Returns the places and every parameter. The range of a parameter differs between effects and is
/// checked there.
std::vector<Option> places_and_parameters(std::string_view kinds) {
  std::vector<Option> out(std::begin(kPlaces), std::end(kPlaces));
  out.front().choices = kinds;
  for (const estimator::EffectDescription& d : estimator::effect_catalogue())
    for (const estimator::EffectParameter& p : d.parameters)
      if (std::none_of(out.begin(), out.end(), [&](const Option& o) { return o.key == p.key; }))
        out.push_back({.key = p.key,
                       .unit = p.unit,
                       .meaning = "Parameter of the kind; see [effects](effects.md)."});
  return out;
}

}  // namespace

std::vector<OptionSection> effect_options() {
  static const std::string kKinds = names_of_effects();
  static const std::vector<Option> kRows = places_and_parameters(kKinds);
  return {{"effect", kRows}};
}

}  // namespace framewatch::daemon
