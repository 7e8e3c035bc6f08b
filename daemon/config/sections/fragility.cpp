#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "daemon/config/keys/section.h"
#include "daemon/config/sections/hazus_limits.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {
namespace {

using estimator::kDamageStates;

constexpr std::array<const char*, kDamageStates> kMedians{
    "slight_drift_ratio", "moderate_drift_ratio", "extensive_drift_ratio", "complete_drift_ratio"};
constexpr std::array<const char*, kDamageStates> kDispersions{
    "slight_dispersion", "moderate_dispersion", "extensive_dispersion", "complete_dispersion"};
constexpr std::array<const char*, 4> kLevels{"high", "moderate", "low", "pre"};

/// The limits of [fragility] type; empty, with a problem, where there are none.
std::optional<std::array<double, kDamageStates>> type_limits(const FragilitySettings& settings,
                                                             int stories, ConfigSection& section,
                                                             std::string& name) {
  if (!section.given("design_level")) {
    if (section.good("design_level"))
      section.problem("design_level",
                      "must be given with type: one of \"high\", \"moderate\", \"low\", \"pre\"");
    return std::nullopt;
  }
  name = settings.drift_limits == DriftLimits::height ? hazus_type_by_height(settings.type, stories)
                                                      : hazus_type_of_story(settings.type);
  const auto limits = hazus_limits(name, settings.design_level);
  if (!limits)
    section.problem("design_level",
                    fmt::format("HAZUS has no drift limits of {} for \"{}\": it has those of "
                                "\"low\" and \"pre\"",
                                name, kLevels[static_cast<std::size_t>(settings.design_level)]));
  return limits;
}

/// A key's value or default of every story; empty after a problem.
std::vector<double> of_stories(ConfigSection& section, const char* key, int stories) {
  if (section.given(key)) return section.grid(key, {stories});
  const std::vector<double> all = section.list(key);
  return all.empty() ? all : std::vector<double>(static_cast<std::size_t>(stories), all.front());
}

/// Medians of every story ascend from slight to complete.
void check_order(const FragilitySettings& settings, ConfigSection& section) {
  for (std::size_t state = 1; state < kDamageStates; ++state)
    for (std::size_t story = 0; story < settings.by_story.size(); ++story) {
      const auto& median = settings.by_story[story].median;
      if (median[state] > median[state - 1]) continue;
      section.problem(
          section.given(kMedians[state]) ? kMedians[state] : kMedians[state - 1],
          fmt::format("the median of story {} must be below {} < {}, got {:g} and {:g}", story + 1,
                      kMedians[state - 1], kMedians[state], median[state - 1], median[state]));
      break;
    }
}

}  // namespace

std::optional<FragilitySettings> read_fragility(const TomlValue& document, int stories,
                                                std::vector<TextProblem>& problems) {
  const TomlEntry* entry = document.find("fragility");
  if (entry == nullptr) return std::nullopt;
  ConfigSection section("fragility", "fragility", &entry->value, {1, 1}, problems);
  FragilitySettings out;
  section.read_into(out);
  std::optional<std::array<double, kDamageStates>> limits;
  std::string name;
  if (section.given("type")) {
    out.type = section.text("type");
    limits = type_limits(out, stories, section, name);
  } else if (section.good("type")) {
    for (const char* median : kMedians)
      if (section.good(median) && !section.given(median))
        section.problem(median, "must be given where there is no type");
    for (const char* of_type : {"design_level", "drift_limits"})
      if (section.given(of_type)) section.problem(of_type, "says nothing without a type");
  }
  if (stories < 1) return out;  // what the structure lacks is a problem of its own
  out.by_story.resize(static_cast<std::size_t>(stories));
  bool whole = true, own = false;
  for (std::size_t state = 0; state < kDamageStates; ++state) {
    std::vector<double> median, dispersion = of_stories(section, kDispersions[state], stories);
    if (section.given(kMedians[state])) {
      median = section.grid(kMedians[state], {stories});
      own = true;
    } else if (limits) {
      median.assign(out.by_story.size(), (*limits)[state]);
    }
    whole = whole && median.size() == out.by_story.size() && dispersion.size() == median.size();
    for (std::size_t story = 0; whole && story < median.size(); ++story) {
      out.by_story[story].median[state] = median[story];
      out.by_story[story].dispersion[state] = dispersion[story];
    }
  }
  if (!whole) return out;
  check_order(out, section);
  out.source = limits ? fmt::format("HAZUS {}, {} code{}", name,
                                    kLevels[static_cast<std::size_t>(out.design_level)],
                                    own ? ", with medians of [fragility]" : "")
                      : "medians of [fragility]";
  return out;
}

}  // namespace framewatch::daemon
