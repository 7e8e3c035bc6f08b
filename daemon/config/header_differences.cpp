// SPDX-License-Identifier: MIT
#include "daemon/config/header_differences.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/core.h>

#include "drivers/stations/station_words.h"

namespace framewatch::daemon {
namespace {

using drivers::AxisHeader;
using drivers::LevelKind;
using estimator::Direction;
using estimator::SensorAxis;

/// Headers round azimuths to whole degrees; sensors are not placed more precisely.
constexpr double kSameAzimuth_deg = 5;
constexpr double kDegrees = 180 / M_PI;

/// A channel of both the record and the configuration.
struct Both {
  const SensorAxis* axis = nullptr;
  const AxisHeader* header = nullptr;
};

std::vector<Both> in_both(const Config& config, const drivers::Record& record) {
  std::vector<Both> out;
  for (const SensorAxis& axis : config.pipeline.axes)
    for (std::size_t c = 0; c < record.headers.size(); ++c)
      if (record.names[c] == axis.name) out.push_back({&axis, &record.headers[c]});
  return out;
}

/// Returns the configured direction of the sensor's positive axis, clockwise from the plan's y.
double from_y_deg(const SensorAxis& axis) {
  double counterclockwise = axis.direction == Direction::y ? M_PI / 2 : 0;  // from x
  if (axis.plan) counterclockwise = axis.plan->angle_rad;
  counterclockwise += axis.mount_angle;
  if (axis.polarity < 0) counterclockwise += M_PI;
  return 90 - counterclockwise * kDegrees;
}

double apart_deg(double a_deg, double b_deg) {
  return std::remainder(a_deg - b_deg, 360);
}

template <class Value, class Same>
std::optional<Value> most_common(const std::vector<Value>& values, const Same& same) {
  std::optional<Value> best;
  std::ptrdiff_t most = 0;
  for (const Value& value : values) {
    const auto count = std::count_if(values.begin(), values.end(),
                                     [&](const Value& other) { return same(value, other); });
    if (count > most) best = value;
    most = std::max(most, count);
  }
  return best;
}

/// Returns the azimuth of the plan's y.
std::optional<double> azimuth_of_y(const Config& config, const std::vector<Both>& channels) {
  if (config.azimuth_y_deg) return config.azimuth_y_deg;
  std::vector<double> candidates;
  for (const Both& both : channels)
    if (is_horizontal(*both.header))
      candidates.push_back(*both.header->azimuth_deg - from_y_deg(*both.axis));
  return most_common(
      candidates, [](double a, double b) { return std::abs(apart_deg(a, b)) <= kSameAzimuth_deg; });
}

std::string about_direction(const Both& both, double azimuth_y_deg) {
  const SensorAxis& axis = *both.axis;
  if (is_vertical(*both.header) && axis.vertical) return {};
  if (is_vertical(*both.header))
    return fmt::format(
        "the sensor measures {}, but the configuration says along {}: its values do not show "
        "the motion of the frames",
        direction_text(*both.header), letter(axis));
  if (!is_horizontal(*both.header)) return {};
  const double header_deg = *both.header->azimuth_deg;
  const double configured_deg = from_y_deg(axis) + azimuth_y_deg;
  const double off_deg = apart_deg(header_deg, configured_deg);
  if (std::abs(off_deg) <= kSameAzimuth_deg) return {};
  const std::string azimuths =
      fmt::format("the sensor points to azimuth {:g} deg, but the configuration says {:.4g} deg",
                  header_deg, std::fmod(configured_deg + 720, 360));
  if (std::abs(off_deg) >= 180 - kSameAzimuth_deg)
    return fmt::format("{}: its motion would have the wrong sign; set polarity = {:.0f}", azimuths,
                       -axis.polarity);
  return fmt::format(
      "{}: its values contain {:.0f} % of the motion in the configured direction and {:.0f} % of "
      "the motion across it",
      azimuths, 100 * std::cos(off_deg / kDegrees), std::abs(100 * std::sin(off_deg / kDegrees)));
}

/// Returns the network's floor number minus the configured story.
std::optional<int> counted_above(const Both& both) {
  const drivers::Level level = level_of(*both.header);
  if (level.kind != LevelKind::floor) return std::nullopt;
  return level.number - both.axis->story;
}

std::string about_level(const Both& both, int stories, std::optional<int> usual) {
  const drivers::Level level = level_of(*both.header);
  const int story = both.axis->story;
  std::string expected;
  if (level.kind == LevelKind::roof && story != stories)
    expected = fmt::format("story {}", stories);
  if (level.kind == LevelKind::basement && story != 0) expected = "story 0, or use = false";
  if (level.kind == LevelKind::outside) expected = "use = false";
  if (level.kind == LevelKind::floor && usual && level.number - story != *usual)
    expected = fmt::format("story {} (counted as for the other channels)", level.number - *usual);
  if (expected.empty()) return {};
  return fmt::format(
      "the sensor is on {} (\"{}\"), but the configuration says story {}: if the header is right, "
      "stiffness and damping of the stories between are wrong; set {}",
      drivers::level_text(level), both.header->place, story, expected);
}

std::string about_unit(const Both& both) {
  const bool is_force = both.header->unit == "N";
  if (is_force && !both.axis->is_force)
    return "its values are a force in N, but the configuration says acceleration: set quantity = "
           "\"force\" for this record";
  if (both.axis->is_force && !is_force && !both.header->unit.empty())
    return fmt::format("its values are in {}, but the configuration says a force in N",
                       both.header->unit);
  if (both.axis->scale == 1 || both.header->unit.empty()) return {};
  return fmt::format(
      "its values, {} in the file, are already converted to m/s^2: scale = {:g} multiplies them "
      "by {:g} again; set scale = 1 for this record",
      both.header->unit, both.axis->scale, both.axis->scale);
}

}  // namespace

std::vector<std::string> header_differences(const Config& config, const drivers::Record& record) {
  const std::vector<Both> channels = in_both(config, record);
  const auto azimuth_y_deg = azimuth_of_y(config, channels);
  std::vector<int> counts;
  for (const Both& both : channels)
    if (const auto above = counted_above(both)) counts.push_back(*above);
  const auto usual = most_common(counts, [](int a, int b) { return a == b; });
  std::vector<std::string> out;
  for (const Both& both : channels)
    for (const std::string& what :
         {about_direction(both, azimuth_y_deg.value_or(0)),
          about_level(both, config.pipeline.structure.stories, usual), about_unit(both)})
      if (!what.empty())
        out.push_back(
            fmt::format("channel {}: the record's header contradicts the configuration: {}",
                        both.axis->name, what));
  return out;
}

}  // namespace framewatch::daemon
