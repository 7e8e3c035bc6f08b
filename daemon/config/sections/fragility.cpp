// SPDX-License-Identifier: MIT
#include "daemon/config/sections/fragility.h"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "daemon/config/keys/section.h"
#include "daemon/config/sections/sections.h"

namespace framewatch::daemon {
namespace {

using estimator::kDamageStates;

constexpr std::array<const char*, kDamageStates> kMedians{
    "slight_drift_ratio", "moderate_drift_ratio", "extensive_drift_ratio", "complete_drift_ratio"};
constexpr std::array<const char*, kDamageStates> kDispersions{
    "slight_dispersion", "moderate_dispersion", "extensive_dispersion", "complete_dispersion"};
constexpr std::array<const char*, 4> kLevels{"high", "moderate", "low", "pre"};

/// Returns the limits of the building type and sets its `name`. Returns nullopt and reports a
/// problem if HAZUS has no limits for it.
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
    section.problem(
        "design_level",
        fmt::format("HAZUS has no drift limits of {} for \"{}\": choose \"low\" or \"pre\"", name,
                    kLevels[static_cast<std::size_t>(settings.design_level)]));
  return limits;
}

/// Returns a key's value or default for every story, or an empty list after a problem.
std::vector<double> of_stories(ConfigSection& section, const char* key, int stories) {
  if (section.given(key)) return section.grid(key, {stories});
  const std::vector<double> all = section.list(key);
  return all.empty() ? all : std::vector<double>(static_cast<std::size_t>(stories), all.front());
}

/// Checks that the medians of every story ascend from slight to complete.
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

using Limits = std::array<double, estimator::kDamageStates>;

struct Row {
  std::string_view types;           ///< separated by blanks
  Limits high, moderate, low, pre;  ///< zeros if HAZUS has no limits
};

constexpr Limits kNone{};

const Row kRows[] = {
    {"W1 W2",
     {.0040, .0120, .0400, .1000},
     {.0040, .0099, .0306, .0750},
     {.0040, .0099, .0306, .0750},
     {.0032, .0079, .0245, .0600}},
    {"S1L",
     {.0060, .0120, .0300, .0800},
     {.0060, .0104, .0235, .0600},
     {.0060, .0096, .0203, .0500},
     {.0048, .0076, .0162, .0400}},
    {"S1M",
     {.0040, .0080, .0200, .0533},
     {.0040, .0069, .0157, .0400},
     {.0040, .0064, .0135, .0333},
     {.0032, .0051, .0108, .0267}},
    {"S1H",
     {.0030, .0060, .0150, .0400},
     {.0030, .0052, .0118, .0300},
     {.0030, .0048, .0101, .0250},
     {.0024, .0038, .0081, .0200}},
    {"S2L C1L",
     {.0050, .0100, .0300, .0800},
     {.0050, .0087, .0233, .0600},
     {.0050, .0080, .0200, .0500},
     {.0040, .0064, .0160, .0400}},
    {"S2M C1M",
     {.0033, .0067, .0200, .0533},
     {.0033, .0058, .0156, .0400},
     {.0033, .0053, .0133, .0333},
     {.0027, .0043, .0107, .0267}},
    {"S2H C1H",
     {.0025, .0050, .0150, .0400},
     {.0025, .0043, .0117, .0300},
     {.0025, .0040, .0100, .0250},
     {.0020, .0032, .0080, .0200}},
    {"S3 PC1",
     {.0040, .0080, .0240, .0700},
     {.0040, .0070, .0187, .0525},
     {.0040, .0064, .0161, .0438},
     {.0032, .0051, .0128, .0350}},
    {"S4L PC2L RM1L RM2L",
     {.0040, .0080, .0240, .0700},
     {.0040, .0069, .0187, .0525},
     {.0040, .0064, .0161, .0438},
     {.0032, .0051, .0128, .0350}},
    {"S4M PC2M RM1M RM2M",
     {.0027, .0053, .0160, .0467},
     {.0027, .0046, .0125, .0350},
     {.0027, .0043, .0107, .0292},
     {.0021, .0034, .0086, .0233}},
    {"S4H",
     {.0020, .0040, .0120, .0350},
     {.0020, .0035, .0093, .0262},
     {.0020, .0032, .0080, .0219},
     {.0016, .0026, .0064, .0175}},
    {"S5L C3L URML", kNone, kNone, {.0030, .0060, .0150, .0350}, {.0024, .0048, .0120, .0280}},
    {"S5M C3M URMM", kNone, kNone, {.0020, .0040, .0100, .0233}, {.0016, .0032, .0080, .0187}},
    {"S5H C3H", kNone, kNone, {.0015, .0030, .0075, .0175}, {.0012, .0024, .0060, .0140}},
    {"C2L",
     {.0040, .0100, .0300, .0800},
     {.0040, .0084, .0232, .0600},
     {.0040, .0076, .0197, .0500},
     {.0032, .0061, .0158, .0400}},
    {"C2M",
     {.0027, .0067, .0200, .0533},
     {.0027, .0056, .0154, .0400},
     {.0027, .0051, .0132, .0333},
     {.0021, .0041, .0105, .0267}},
    {"C2H",
     {.0020, .0050, .0150, .0400},
     {.0020, .0042, .0116, .0300},
     {.0020, .0038, .0099, .0250},
     {.0016, .0031, .0079, .0200}},
    {"PC2H RM2H",
     {.0020, .0040, .0120, .0350},
     {.0020, .0035, .0094, .0263},
     {.0020, .0032, .0080, .0219},
     {.0016, .0026, .0064, .0175}},
};

/// Returns true if `word` is one of the words of `list`, which blanks separate.
bool has_word(std::string_view list, std::string_view word) {
  return fmt::format(" {} ", list).find(fmt::format(" {} ", word)) != std::string::npos;
}

const Row* find(std::string_view type) {
  const auto at = std::find_if(std::begin(kRows), std::end(kRows),
                               [&](const Row& row) { return has_word(row.types, type); });
  return at == std::end(kRows) ? nullptr : at;
}

}  // namespace

std::optional<FragilitySettings> read_fragility(const TomlValue& document, int stories,
                                                std::vector<TextProblem>& problems) {
  if (!document.find("fragility")) return std::nullopt;
  ConfigSection section("fragility", document, problems);
  auto out = section.read<FragilitySettings>();
  std::optional<std::array<double, kDamageStates>> limits;
  std::string name;
  if (section.given("type")) {
    out.type = section.text("type");
    limits = type_limits(out, stories, section, name);
  } else if (section.good("type")) {
    for (const char* median : kMedians)
      if (section.good(median) && !section.given(median))
        section.problem(median, "must be given if there is no type");
    for (const char* of_type : {"design_level", "drift_limits"})
      if (section.given(of_type)) section.problem(of_type, "has no effect without a type");
  }
  if (stories < 1) return out;  // an invalid structure is reported elsewhere
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

std::optional<Limits> hazus_limits(const std::string& type, DesignLevel level) {
  const Row* row = find(type);
  if (row == nullptr) return std::nullopt;
  const Limits& out = level == DesignLevel::high       ? row->high
                      : level == DesignLevel::moderate ? row->moderate
                      : level == DesignLevel::low      ? row->low
                                                       : row->pre;
  return out == kNone ? std::nullopt : std::optional(out);
}

std::string hazus_type_by_height(const std::string& type, int stories) {
  if (find(type) != nullptr) return type;
  const int low = type == "URM" ? 2 : 3, mid = type == "URM" || type == "RM1" ? stories : 7;
  return type + (stories <= low ? "L" : stories <= mid ? "M" : "H");
}

std::string hazus_type_of_story(const std::string& type) {
  return find(type) != nullptr ? type : type + "L";
}

}  // namespace framewatch::daemon
