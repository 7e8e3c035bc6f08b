// SPDX-License-Identifier: MIT
#include <algorithm>
#include <list>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "daemon/config/keys/option_table.h"
#include "estimator/structure/effect.h"

namespace framewatch::daemon {
namespace {

using enum OptionType;

/// Owns the texts that the options point to.
class EffectOptions {
 public:
  EffectOptions() {
    std::string names;
    for (const estimator::EffectDescription& d : estimator::effect_catalogue())
      names += (names.empty() ? "" : "|") + std::string(d.name);
    add_place("kind", choice, "Kind of effect.");
    all_.back().required = true;
    all_.back().choices = keep(names);
    add_place("story", integer, "Story of the frame story, panel, node or floor.");
    all_.back().range.min = 1;
    all_.back().range.max = 1000;
    add_place("frame", text, "Name of the frame.");
    add_place("panel", text,
              "Floor panel, named after the frames where its spans start: \"x1y1\".");
    add_place("node", text, "Crossing of a y-parallel and an x-parallel frame: \"x1y1\".");
    add_place("to_story", integer, "Lower floor of two; 0 is the base.");
    all_.back().default_value = "0";
    all_.back().range.min = 0;
    all_.back().range.max = 1000;
    add_place("direction", choice, "Direction, for effects of the whole building.");
    all_.back().choices = "x|y";
    add_place("mode", integer, "Mode, in the order of natural frequencies.");
    all_.back().range.min = 1;
    all_.back().range.max = 100000;
    add_place("channel", text, "Name of the channel.");
    add_place("with_channel", text, "Name of the other channel.");
    for (const estimator::EffectDescription& d : estimator::effect_catalogue())
      for (const estimator::EffectParameter& p : d.parameters) add_parameter(p);
  }

  std::span<const Option> options() const { return all_; }

 private:
  std::string_view keep(const std::string& words) { return texts_.emplace_back(words); }

  void add_place(std::string_view key, OptionType type, std::string_view meaning) {
    Option o;
    o.key = key;
    o.type = type;
    o.meaning = meaning;
    all_.push_back(o);
  }

  /// Adds a parameter. Its range differs between effects and is checked there.
  void add_parameter(const estimator::EffectParameter& p) {
    const auto known =
        std::find_if(all_.begin(), all_.end(), [&](const Option& o) { return o.key == p.key; });
    if (known != all_.end()) return;
    add_place(p.key, number, "Parameter of the kind; see [effects](effects.md).");
    all_.back().unit = p.unit;
  }

  std::list<std::string> texts_;
  std::vector<Option> all_;
};

}  // namespace

std::vector<OptionSection> effect_options() {
  static const EffectOptions kOptions;
  return {{"effect", kOptions.options()}};
}

}  // namespace framewatch::daemon
