// SPDX-License-Identifier: MIT
#include "daemon/tools/init/station_layout.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/core.h>

#include "drivers/files/number_text.h"

namespace framewatch::daemon {
namespace {

using drivers::AxisHeader;
using drivers::Level;
using drivers::LevelKind;
using drivers::Side;

constexpr double kRadians = M_PI / 180;
constexpr double kMeridian_m = 111'195;  ///< length of a degree of latitude
/// Sensors of one building are not farther apart; larger coordinates are the station's.
constexpr double kFarthest_m = 1000;

/// True for levels within the building, where every floor has the same axes.
bool is_inside(const Level& level) {
  return level.kind != LevelKind::outside && level.kind != LevelKind::unknown;
}

/// Returns the azimuth, of this direction or its perpendicular, that is nearest to north: -45 to 45
/// deg.
double folded_deg(double azimuth_deg) {
  return std::remainder(azimuth_deg, 90);
}

/// Returns the most frequent azimuth of horizontal directions.
std::optional<double> azimuth_of_y(const std::vector<ChannelColumn>& columns,
                                   const std::vector<Level>& levels) {
  std::map<double, int> count;
  for (std::size_t c = 0; c < columns.size(); ++c)
    if (is_inside(levels[c]) && is_horizontal(columns[c].header))
      ++count[folded_deg(*columns[c].header.azimuth_deg)];
  const auto most = std::max_element(
      count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == count.end() ? std::nullopt : std::optional(most->first);
}

bool is_along_y(double azimuth_deg, double azimuth_y_deg) {
  return std::abs(std::cos((azimuth_deg - azimuth_y_deg) * kRadians)) > std::sqrt(0.5);
}

/// Returns meters east and north of the station's reference or the first sensor, or nullopt.
struct Offset {
  double east_m = 0, north_m = 0;
};
std::optional<Offset> offset_of(const AxisHeader& header, const AxisHeader& first) {
  if (header.east_m && header.north_m) return Offset{*header.east_m, *header.north_m};
  if (!header.latitude_deg || !header.longitude_deg || !first.latitude_deg || !first.longitude_deg)
    return std::nullopt;
  const double north_m = (*header.latitude_deg - *first.latitude_deg) * kMeridian_m;
  const double east_m = std::remainder(*header.longitude_deg - *first.longitude_deg, 360) *
                        kMeridian_m * std::cos(*first.latitude_deg * kRadians);
  return Offset{east_m, north_m};
}

/// Sets places in m along x and y from the least. Needs a place for every horizontal channel; equal
/// places are the station's coordinates and are ignored.
std::vector<std::optional<std::pair<double, double>>> places_m(
    const StationReading& reading, const std::vector<ChannelColumn>& columns) {
  std::vector<std::optional<std::pair<double, double>>> out(columns.size());
  const double angle = reading.azimuth_y_deg * kRadians;
  const AxisHeader* first = nullptr;
  double least_x = 0, least_y = 0, most = 0;
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (!is_inside(reading.levels[c])) continue;
    if (first == nullptr) first = &columns[c].header;
    const auto at = offset_of(columns[c].header, *first);
    if (!at) return std::vector<std::optional<std::pair<double, double>>>(columns.size());
    const double x_m = at->east_m * std::cos(angle) - at->north_m * std::sin(angle);
    const double y_m = at->east_m * std::sin(angle) + at->north_m * std::cos(angle);
    least_x = first == &columns[c].header ? x_m : std::min(least_x, x_m);
    least_y = first == &columns[c].header ? y_m : std::min(least_y, y_m);
    out[c] = std::pair(x_m, y_m);
  }
  for (auto& at : out) {
    if (!at) continue;
    at->first -= least_x;
    at->second -= least_y;
    most = std::max({most, at->first, at->second});
  }
  if (most < 1e-3 || most > kFarthest_m) out.assign(columns.size(), std::nullopt);
  return out;
}

/// Returns -1, 0 or 1 along the plan's x and y.
std::pair<int, int> along_plan(const Side& side, double azimuth_y_deg) {
  const double angle = azimuth_y_deg * kRadians;
  const double x = side.east * std::cos(angle) - side.north * std::sin(angle);
  const double y = side.east * std::sin(angle) + side.north * std::cos(angle);
  const auto sign = [](double v) { return v > 0.5 ? 1 : v < -0.5 ? -1 : 0; };
  return {sign(x), sign(y)};
}

/// Returns the story of a level, or nullopt if this building does not have the level.
std::optional<int> story_of(const Level& level, const StationPlan& plan) {
  switch (level.kind) {
    case LevelKind::roof:
      return plan.stories;
    case LevelKind::basement:
      return 0;
    case LevelKind::floor: {
      const int story = plan.base_is_basement ? level.number : level.number - 1;
      return story <= plan.stories ? std::optional(story) : std::nullopt;
    }
    case LevelKind::outside:
      return 0;
    case LevelKind::unknown:
      break;
  }
  return std::nullopt;
}

std::optional<char> letter_of(const AxisHeader& header, double azimuth_y_deg) {
  if (is_vertical(header)) return 'z';
  if (!is_horizontal(header)) return std::nullopt;
  return is_along_y(*header.azimuth_deg, azimuth_y_deg) ? 'y' : 'x';
}

std::string why_unused(const Level& level, char along, const StationPlan& plan) {
  if (level.kind == LevelKind::outside) return "not in the building";
  if (level.kind == LevelKind::basement && !plan.base_is_basement) return "below the base";
  if (along == 'z') return "vertical";
  return (along == 'x' ? plan.has_x : plan.has_y) ? "" : "no frame has its direction";
}

}  // namespace

std::optional<StationReading> read_station(const std::vector<ChannelColumn>& columns) {
  StationReading out;
  for (const ChannelColumn& column : columns) {
    out.levels.push_back(drivers::level_of(column.header));
    out.sides.push_back(drivers::side_of(column.header));
  }
  const auto azimuth_y_deg = azimuth_of_y(columns, out.levels);
  if (!azimuth_y_deg) return std::nullopt;
  out.azimuth_y_deg = *azimuth_y_deg;
  const auto metres = places_m(out, columns);
  std::map<LevelKind, std::map<char, int>>
      lowest;  // lowest levels of the first floor and the basement
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const Level& level = out.levels[c];
    const auto along = letter_of(columns[c].header, out.azimuth_y_deg);
    if (!is_inside(level) || !along || *along == 'z') continue;
    (*along == 'x' ? out.along_x : out.along_y) = true;
    if (level.kind == LevelKind::floor)
      out.highest_floor = std::max(out.highest_floor, level.number);
    out.has_roof = out.has_roof || level.kind == LevelKind::roof;
    if (level.kind == LevelKind::basement || level == Level{LevelKind::floor, 1})
      ++lowest[level.kind][*along];
    const auto [x, y] = along_plan(out.sides[c], out.azimuth_y_deg);
    out.needs_plan_x = out.needs_plan_x || (x != 0 && !metres[c]);
    out.needs_plan_y = out.needs_plan_y || (y != 0 && !metres[c]);
  }
  const auto measures_all = [&](LevelKind kind) {
    return (!out.along_x || lowest[kind]['x'] > 0) && (!out.along_y || lowest[kind]['y'] > 0);
  };
  out.ground_can_be_base = measures_all(LevelKind::floor);
  out.basement_can_be_base = measures_all(LevelKind::basement);
  return out;
}

std::optional<StationPlace> station_place(const StationReading& reading,
                                          const std::vector<ChannelColumn>& columns, std::size_t c,
                                          const StationPlan& plan, std::string& why) {
  const AxisHeader& header = columns[c].header;
  const Level& level = reading.levels[c];
  const auto story = story_of(level, plan);
  const auto along = letter_of(header, reading.azimuth_y_deg);
  if (!story)
    why = level.kind == LevelKind::unknown
              ? "its header does not say the level"
              : fmt::format("its header says {}, which is above the roof of {} stories",
                            drivers::level_text(level), plan.stories);
  else if (!along)
    why = "its header does not say the direction";
  if (!why.empty()) return std::nullopt;
  StationPlace out = place_on_floor(reading, columns, c, plan);
  out.story = *story;
  out.why_unused = why_unused(level, *along, plan);
  return out;
}

StationPlace place_on_floor(const StationReading& reading,
                            const std::vector<ChannelColumn>& columns, std::size_t c,
                            const StationPlan& plan) {
  const AxisHeader& header = columns[c].header;
  StationPlace out;
  out.along = letter_of(header, reading.azimuth_y_deg).value_or('x');
  if (is_horizontal(header)) out.azimuth_deg = *header.azimuth_deg;
  if (const auto metres = places_m(reading, columns)[c]) {
    out.x_m = metres->first;
    out.y_m = metres->second;
    return out;
  }
  const auto [x, y] = along_plan(reading.sides[c], reading.azimuth_y_deg);
  if (x != 0 && plan.x_m > 0) out.x_m = x > 0 ? plan.x_m : 0;
  if (y != 0 && plan.y_m > 0) out.y_m = y > 0 ? plan.y_m : 0;
  return out;
}

std::optional<StationPlace> parse_station_place(const std::string& text, const StationPlace& header,
                                                const StationPlan& plan) {
  StationPlace out = header;
  if (text == "unused") {
    out.why_unused = "as answered";
    return out;
  }
  const std::size_t colon = text.find(':');
  const std::string floor(drivers::trimmed(std::string_view(text).substr(0, colon)));
  const auto number = drivers::parse_integer(floor);
  if (floor != "base" && floor != "roof" && (!number || *number < 0 || *number > plan.stories))
    return std::nullopt;
  out.story = floor == "base" ? 0 : floor == "roof" ? plan.stories : static_cast<int>(*number);
  if (colon != std::string::npos) {
    const std::string along(drivers::trimmed(std::string_view(text).substr(colon + 1)));
    if (along != "x" && along != "y" && along != "z") return std::nullopt;
    out.along = along.front();
    out.azimuth_deg.reset();
  } else if (!out.azimuth_deg && out.along != 'z') {
    return std::nullopt;
  }
  out.why_unused = out.along == 'z' ? "vertical" : "";
  return out;
}

std::string station_place_text(const StationPlace& place) {
  std::string out = place.story == 0 ? "base" : fmt::format("floor {}", place.story);
  out += place.along == 'z' ? ", vertical" : fmt::format(", along {}", place.along);
  if (place.x_m) out += fmt::format(", x {:.4g} m", *place.x_m);
  if (place.y_m) out += fmt::format(", y {:.4g} m", *place.y_m);
  return place.why_unused.empty() ? out : "not used: " + place.why_unused;
}

}  // namespace framewatch::daemon
