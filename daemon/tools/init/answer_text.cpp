// SPDX-License-Identifier: MIT
#include "daemon/tools/init/answer_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/core.h>

#include "daemon/config/plausibility/plausible_limits.h"
#include "drivers/files/number_text.h"

namespace framewatch::daemon {
namespace {

constexpr double kPeriodOfStory_s = 0.1;

double height_m(const BuildingDraft& d) {
  const std::vector<double>& heights = d.plan.structure.story_height;
  return std::accumulate(heights.begin(), heights.end(), 0.0);
}

/// Returns the mass of each floor, kg.
std::vector<double> masses_of_floors(const estimator::Structure& s) {
  const std::size_t nodes = s.node_mass.size() / static_cast<std::size_t>(s.stories);
  std::vector<double> out(static_cast<std::size_t>(s.stories), 0.0);
  for (std::size_t i = 0; i < s.node_mass.size(); ++i) out[i / nodes] += s.node_mass[i];
  return out;
}

void start_from_frequencies(double x_hz, double y_hz, const std::string& from, BuildingDraft& d) {
  const std::vector<double> masses = masses_of_floors(d.plan.structure);
  if (d.has_x) d.plan.story_kx_npm = story_stiffness_npm(masses, x_hz);
  if (d.has_y) d.plan.story_ky_npm = story_stiffness_npm(masses, y_hz);
  d.plan.stiffness_from = from;
}

std::string take_frequencies(std::vector<double> values, bool periods, BuildingDraft& d) {
  if (values.size() > 2) return "give one first frequency, or two: along x, along y";
  if (values.size() == 2 && !(d.has_x && d.has_y))
    return "give one: only one direction is measured";
  std::string from = fmt::format(
      "first natural {} {} {}{}, as given", periods ? "period" : "frequency", list_text(values),
      periods ? "s" : "Hz", values.size() == 2 ? " (along x, along y)" : "");
  if (periods)
    for (double& value : values) value = 1 / value;
  start_from_frequencies(values.front(), values.back(), from, d);
  return "";
}

std::string take_stiffness(const Quantity& quantity, double unit_npm, BuildingDraft& d) {
  const auto values = spread(quantity.values, static_cast<std::size_t>(d.plan.structure.stories));
  if (!values)
    return fmt::format("there are {} numbers: give one for all stories, or {}",
                       quantity.values.size(), d.plan.structure.stories);
  std::vector<double> stories = *values;
  for (double& stiffness : stories) stiffness *= unit_npm;
  if (d.has_x) d.plan.story_kx_npm = stories;
  if (d.has_y) d.plan.story_ky_npm = stories;
  d.plan.stiffness_from = fmt::format("{} {} a story and direction, as given",
                                      list_text(quantity.values), quantity.unit);
  return "";
}

constexpr const char* kForms =
    "a frequency (1.8 Hz; 1.8, 2.1 Hz along x and y), a period (0.55 s), the stiffness of a story "
    "(25 MN/m, one or each), height, stories or none";

constexpr int kMaxBays = 20;
constexpr std::size_t kMaxDecimals = 3;  ///< decimals that people type: 18000,20000 are two masses

bool may_be_decimal_comma(std::string_view text) {
  const std::size_t comma = text.find(',');
  const auto is_digit = [&](std::size_t at) {
    return at < text.size() && text[at] >= '0' && text[at] <= '9';
  };
  std::size_t decimals = 0;
  while (comma != std::string_view::npos && is_digit(comma + 1 + decimals)) ++decimals;
  return decimals > 0 && decimals <= kMaxDecimals && comma > 0 && is_digit(comma - 1) &&
         text.find(',', comma + 1) == std::string_view::npos &&
         text.find('.') == std::string_view::npos;
}

}  // namespace

std::string ask_start(const BuildingDraft& d) {
  std::string out =
      "What is known of the stiffness? Tuning starts there. Give the first natural frequency (1.8 "
      "Hz; "
      "1.8,\n2.1 Hz along x and y), the period (0.55 s), the stiffness of a story (25 MN/m), or a "
      "rule "
      "of thumb:\nheight";
  if (height_m(d) > 0)
    out += fmt::format(" ({:.2g} Hz, 46 / height)", kFrequencyTimesHeight_mps / height_m(d));
  out += " or stories";
  if (d.stories_known)
    out += fmt::format(" ({:.2g} Hz, T = 0.1 s per story)",
                       1 / (kPeriodOfStory_s * d.plan.structure.stories));
  return out + ", or none?";
}

std::string initial_start(const BuildingDraft& d) {
  return height_m(d) >= kMinBuildingStory_m * d.plan.structure.stories ? "height" : "none";
}

std::string take_start(const std::string& text, BuildingDraft& d, ColumnCache&) {
  const auto quantity = parse_quantity(text);
  constexpr std::array<std::pair<const char*, double>, 3> kStiffness = {
      {{"N/m", 1.0}, {"kN/m", 1e3}, {"MN/m", 1e6}}};
  bool known = text == "none" || text == "height" || text == "stories";
  if (quantity) {
    known = quantity->unit == "Hz" || quantity->unit == "s";
    for (const auto& [unit, npm] : kStiffness) known = known || quantity->unit == unit;
  }
  if (!known) return why_no_quantity(text, kForms);
  if (text == "none") {
    d.plan.stiffness_from = "none: the filters find their frequencies from the data";
    return "";
  }
  if (d.plan.structure.node_mass.empty() || height_m(d) <= 0)
    return "";  // other questions ask for these
  if (text == "height") {
    const double hz = kFrequencyTimesHeight_mps / height_m(d);
    start_from_frequencies(
        hz, hz, fmt::format("first natural frequency {:.3g} Hz, by the rule 46 / height", hz), d);
    return "";
  }
  if (text == "stories") {
    const double hz = 1 / (kPeriodOfStory_s * d.plan.structure.stories);
    start_from_frequencies(
        hz, hz, fmt::format("first natural frequency {:.3g} Hz, by the rule T = 0.1 s a story", hz),
        d);
    return "";
  }
  for (const auto& [unit, npm] : kStiffness)
    if (quantity->unit == unit) return take_stiffness(*quantity, npm, d);
  return take_frequencies(quantity->values, quantity->unit == "s", d);
}

std::string why_no_quantity(std::string_view text, const std::string& rule) {
  if (!may_be_decimal_comma(text)) return rule;
  return "the comma may be decimal or separate two numbers: write 3.5, or 3, 5 with a blank";
}

std::optional<Quantity> parse_quantity(std::string_view text) {
  if (may_be_decimal_comma(text)) return std::nullopt;
  Quantity out;
  std::string_view rest = drivers::trimmed(text);
  for (;;) {
    const std::size_t end = rest.find_first_not_of("0123456789.eE+-");
    std::string_view number = rest.substr(0, end);
    auto value = drivers::parse_number(number);
    if (!value || !std::isfinite(*value) || *value <= 0) return std::nullopt;
    out.values.push_back(*value);
    rest = drivers::trimmed(rest.substr(number.size()));
    if (rest.empty() || rest.front() != ',') break;
    rest = drivers::trimmed(rest.substr(1));
  }
  out.unit = std::string(rest);
  std::erase(out.unit, ' ');
  return out;
}

std::optional<std::vector<double>> spread(const std::vector<double>& values, std::size_t count) {
  if (values.size() == 1) return std::vector<double>(count, values.front());
  if (values.size() == count) return values;
  return std::nullopt;
}

std::optional<Bays> parse_bays(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos) return std::nullopt;
  const auto x = drivers::parse_integer(drivers::trimmed(text.substr(0, cross)));
  const auto y = drivers::parse_integer(drivers::trimmed(text.substr(cross + 1)));
  const auto good = [](const auto& n) { return n && *n >= 0 && *n <= kMaxBays; };
  if (!good(x) || !good(y)) return std::nullopt;
  return Bays{static_cast<int>(*x), static_cast<int>(*y)};
}

std::string list_text(const std::vector<double>& values) {
  const bool equal =
      std::all_of(values.begin(), values.end(), [&](double v) { return v == values.front(); });
  std::string out;
  for (const double value : values) {
    out += fmt::format("{}{:.6g}", out.empty() ? "" : ", ", value);
    if (equal) break;
  }
  return out;
}

}  // namespace framewatch::daemon
