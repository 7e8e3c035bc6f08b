// SPDX-License-Identifier: MIT
#include "daemon/tools/init/building_plan.h"

#include <numeric>

#include <fmt/core.h>

#include "drivers/files/number_text.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::daemon {
namespace {

using estimator::Direction;

std::optional<int> parse_story(const estimator::Structure& s, std::string_view text) {
  if (text == "base") return 0;
  if (text == "roof") return s.stories;
  const auto number = drivers::parse_integer(text);
  if (!number || *number < 0 || *number > s.stories) return std::nullopt;
  return static_cast<int>(*number);
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

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
  if (place.story == 0) return fmt::format("base, along {}", letter(place.direction));
  return fmt::format("floor {}, frame {}, along {}", place.story, s.frame_name(place.frame),
                     letter(place.direction));
}

std::string place_option(const estimator::Structure& s, const Place& place) {
  return place.story == 0 ? fmt::format("0:{}", letter(place.direction))
                          : fmt::format("{}:{}", place.story, s.frame_name(place.frame));
}

std::optional<Place> parse_place(const estimator::Structure& s, std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto story = parse_story(s, drivers::trimmed(text.substr(0, colon)));
  const std::string_view rest = drivers::trimmed(text.substr(colon + 1));
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
