// SPDX-License-Identifier: MIT
#include "daemon/tools/init/building_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/core.h>

#include "drivers/files/number_text.h"
#include "estimator/structure/natural_frequencies.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::daemon {
namespace {

using estimator::Direction;

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Parses "(4,1.5)" or "4,1.5".
std::optional<PlanPoint> parse_point(std::string_view text) {
  constexpr double kFarthestPoint_m = 1000;
  if (text.starts_with('(') && text.ends_with(')')) text = text.substr(1, text.size() - 2);
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto x_m = drivers::parse_number(drivers::trimmed(text.substr(0, comma)));
  const auto y_m = drivers::parse_number(drivers::trimmed(text.substr(comma + 1)));
  const auto possible = [](const auto& v) { return v && std::abs(*v) <= kFarthestPoint_m; };
  if (!possible(x_m) || !possible(y_m)) return std::nullopt;
  return PlanPoint{*x_m, *y_m};
}

/// Parses "2@(4,1.5)" and the letter behind its colon.
std::optional<Place> parse_point_place(const estimator::Structure& s, std::string_view where,
                                       std::string_view along) {
  const std::size_t at = where.find('@');
  const auto story = parse_story(s, drivers::trimmed(where.substr(0, at)));
  const auto point = parse_point(drivers::trimmed(where.substr(at + 1)));
  if (!story || !point || along.size() != 1) return std::nullopt;
  if (along == "z") return Place{*story, -1, Direction::x, point, true};
  if (along != "x" && along != "y") return std::nullopt;
  const Direction direction = along == "x" ? Direction::x : Direction::y;
  if ((direction == Direction::x ? s.n() : s.m()) == 0) return std::nullopt;
  return Place{*story, -1, direction, point};
}

PlanPoint middle_of(const estimator::Structure& s) {
  return {sum(s.span_x) / 2, sum(s.span_y) / 2};
}

}  // namespace

char letter(const Place& place) {
  return place.vertical ? 'z' : letter(place.direction)[0];
}

std::optional<int> parse_story(const estimator::Structure& s, std::string_view text) {
  if (text == "base") return 0;
  if (text == "roof") return s.stories;
  const auto number = drivers::parse_integer(text);
  if (!number || *number < 0 || *number > s.stories) return std::nullopt;
  return static_cast<int>(*number);
}

PlanPoint point_of(const estimator::Structure& s, const Place& place) {
  PlanPoint out = middle_of(s);
  if (place.at) return *place.at;
  if (place.frame >= 0)
    (s.direction(place.frame) == Direction::x ? out.y_m : out.x_m) = line_position(s, place.frame);
  return out;
}

std::vector<Place> places_on_level(const estimator::Structure& s, int story,
                                   const std::string& letters) {
  std::vector<Place> out;
  for (const Direction direction : {Direction::x, Direction::y}) {
    const auto count = std::count(letters.begin(), letters.end(), letter(direction)[0]);
    const int frames = direction == Direction::x ? s.n() : s.m();
    for (int i = 0; i < count; ++i) {
      Place place{story, -1, direction};
      if (count > 1)
        place.frame = static_cast<int>(
            std::lround(static_cast<double>(i) * (frames - 1) / static_cast<double>(count - 1)));
      else if (frames == 1)
        place.frame = 0;
      else
        place.at = middle_of(s);
      if (place.frame >= 0 && direction == Direction::y) place.frame += s.n();
      if (story == 0 && count > 1) place.at = point_of(s, place);
      if (story == 0) place.frame = -1;
      if (story == 0 && count == 1) place.at.reset();
      out.push_back(place);
    }
  }
  for (const char along : letters)
    if (along == 'z') out.push_back({story, -1, Direction::x, middle_of(s), true});
  return out;
}

std::optional<int> only_frame(const estimator::Structure& s, Direction along) {
  if (along == Direction::x) return s.n() == 1 ? std::optional(0) : std::nullopt;
  return s.m() == 1 ? std::optional(s.n()) : std::nullopt;
}

std::vector<Place> places_of(const estimator::Structure& s) {
  std::vector<Place> out;
  if (s.n() > 0) out.push_back({0, -1, Direction::x});
  if (s.m() > 0) out.push_back({0, -1, Direction::y});
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f) out.push_back({story, f, s.direction(f)});
  return out;
}

std::string place_text(const estimator::Structure& s, const Place& place) {
  const std::string level = place.story == 0 ? "base" : fmt::format("floor {}", place.story);
  if (place.at)
    return fmt::format("{}, {}{} at ({:.6g}, {:.6g}) m", level, place.vertical ? "" : "along ",
                       place.vertical ? "vertical" : letter(place.direction), place.at->x_m,
                       place.at->y_m);
  if (place.story == 0) return fmt::format("base, along {}", letter(place.direction));
  return fmt::format("floor {}, frame {}, along {}", place.story, s.frame_name(place.frame),
                     letter(place.direction));
}

std::string place_option(const estimator::Structure& s, const Place& place) {
  if (place.at)
    return fmt::format("{}@({:.6g},{:.6g}):{}", place.story, place.at->x_m, place.at->y_m,
                       letter(place));
  return place.story == 0 ? fmt::format("0:{}", letter(place.direction))
                          : fmt::format("{}:{}", place.story, s.frame_name(place.frame));
}

std::optional<Place> parse_place(const estimator::Structure& s, std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const std::string_view where = drivers::trimmed(text.substr(0, colon));
  const std::string_view rest = drivers::trimmed(text.substr(colon + 1));
  if (where.find('@') != std::string_view::npos) return parse_point_place(s, where, rest);
  const auto story = parse_story(s, where);
  if (!story) return std::nullopt;
  if (rest == "x" || rest == "y") {
    const Direction along = rest == "x" ? Direction::x : Direction::y;
    if ((along == Direction::x ? s.n() : s.m()) == 0) return std::nullopt;
    if (*story == 0) return Place{0, -1, along};
    const auto frame = only_frame(s, along);
    return frame ? std::optional(Place{*story, *frame, along}) : std::nullopt;
  }
  for (int f = 0; f < s.frames() && *story > 0; ++f)
    if (s.frame_name(f) == rest) return Place{*story, f, s.direction(f)};
  return std::nullopt;
}

std::vector<double> shares_of_frames(const std::vector<double>& spans) {
  if (spans.empty()) return {1.0};
  std::vector<double> out(spans.size() + 1, 0.0);
  for (std::size_t i = 0; i < spans.size(); ++i) {
    out[i] += spans[i] / 2 / sum(spans);
    out[i + 1] += spans[i] / 2 / sum(spans);
  }
  return out;
}

std::vector<double> node_masses(const estimator::Structure& s,
                                const std::vector<double>& floor_mass_kg) {
  std::vector<double> out;
  for (const double mass : floor_mass_kg)
    for (const double y : shares_of_frames(s.span_y))
      for (const double x : shares_of_frames(s.span_x)) out.push_back(mass * y * x);
  return out;
}

double floor_area_m2(const estimator::Structure& s) {
  return sum(s.span_x) * sum(s.span_y);
}

std::vector<double> story_stiffness_npm(const std::vector<double>& floor_mass_kg, double first_hz) {
  estimator::Structure line;
  line.stories = static_cast<int>(floor_mass_kg.size());
  line.frames_x = {"y1"};
  line.node_mass = floor_mass_kg;
  line.story_height.assign(floor_mass_kg.size(), 1.0);
  const estimator::ParameterTable table(line);
  const double unit_hz = lowest_frequency_hz(line, table, Eigen::VectorXd::Ones(table.size()));
  const double stiffness = first_hz / unit_hz * (first_hz / unit_hz);
  return std::vector<double>(floor_mass_kg.size(), stiffness);
}

}  // namespace framewatch::daemon
