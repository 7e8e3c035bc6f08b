// SPDX-License-Identifier: MIT
#include "daemon/tools/init/plan_drawing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/printable.h"
#include "estimator/structure/story_groups.h"

namespace framewatch::daemon {
namespace {

using estimator::Direction;
using estimator::Structure;

/// An accelerometer in plan.
struct DrawnSensor {
  std::string name;
  char along;
  PlanPoint at;
};

struct DrawnLevel {
  int story;
  std::vector<DrawnSensor> sensors;
};

/// Returns the floors that have channels, top first. Channels that are not used are left out.
std::vector<DrawnLevel> drawn_levels(const BuildingPlan& p) {
  std::vector<DrawnLevel> out;
  for (int story = p.structure.stories; story >= 0; --story) {
    DrawnLevel level{story, {}};
    for (const PlannedChannel& channel : p.channels) {
      PlanPoint at = point_of(p.structure, channel.place);
      if (const auto& station = channel.station) {
        if (station->story != story || !station->why_unused.empty()) continue;
        at = {station->x_m.value_or(at.x_m), station->y_m.value_or(at.y_m)};
        level.sensors.push_back({channel.column.name, station->along, at});
      } else if (channel.place.story == story && !channel.place.vertical) {
        level.sensors.push_back({channel.column.name, letter(channel.place), at});
      }
    }
    if (!level.sensors.empty()) out.push_back(std::move(level));
  }
  return out;
}

/// Floors whose accelerometers stand alike.
struct Arrangement {
  std::vector<int> stories;
  std::vector<DrawnSensor> sensors;  ///< of the highest of these floors
};

std::vector<Arrangement> arrangements(const std::vector<DrawnLevel>& levels) {
  const auto alike = [](const std::vector<DrawnSensor>& a, const std::vector<DrawnSensor>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const DrawnSensor& one, const DrawnSensor& other) {
                        return one.along == other.along && one.at == other.at;
                      });
  };
  std::vector<Arrangement> out;
  for (const DrawnLevel& level : levels) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const Arrangement& a) {
      return alike(a.sensors, level.sensors);
    });
    if (same == out.end())
      out.push_back({{level.story}, level.sensors});
    else
      same->stories.push_back(level.story);
  }
  return out;
}

std::string level_name(const Structure& s, int story) {
  return story == 0           ? "base"
         : story == s.stories ? fmt::format("{} roof", story)
                              : fmt::format("{}", story);
}

std::string plan_title(const Structure& s, const Arrangement& a) {
  std::string out;
  for (const int story : a.stories) out += (out.empty() ? "" : ", ") + level_name(s, story);
  if (out == "base") return "Plan of the base";
  return (a.stories.size() > 1 ? "Plan of floors " : "Plan of floor ") + out;
}

/// The plan with its frames and accelerometers on a rectangle of the drawing. A direction without
/// spans has one line in the middle.
struct Canvas {
  double left_m = 0, right_m = 0, low_m = 0, high_m = 0;

  Canvas(const Structure& s, const std::vector<DrawnLevel>& levels) {
    for (int f = 0; f < s.frames(); ++f)
      (s.direction(f) == Direction::x ? high_m : right_m) =
          std::max(s.direction(f) == Direction::x ? high_m : right_m, line_position(s, f));
    for (const DrawnLevel& level : levels)
      for (const DrawnSensor& sensor : level.sensors) {
        left_m = std::min(left_m, sensor.at.x_m);
        right_m = std::max(right_m, sensor.at.x_m);
        low_m = std::min(low_m, sensor.at.y_m);
        high_m = std::max(high_m, sensor.at.y_m);
      }
  }
  /// Returns the share of the width from the left, or of the height from the top.
  double across(double x_m) const {
    return right_m > left_m ? (x_m - left_m) / (right_m - left_m) : 0.5;
  }
  double down(double y_m) const { return high_m > low_m ? (high_m - y_m) / (high_m - low_m) : 0.5; }
  /// Returns height over width, from a fifth to three.
  double shape() const {
    const bool flat = right_m <= left_m || high_m <= low_m;
    return flat ? 0.4 : std::clamp((high_m - low_m) / (right_m - left_m), 0.2, 3.0);
  }
};

/// Returns the plan of an arrangement in characters.
std::string grid_text(const Structure& s, const Canvas& canvas, const Arrangement& a) {
  constexpr int kMostColumns = 41, kMostRows = 11;
  constexpr double kRowOverColumn = 2.1;  // a character is twice as high as wide
  int columns = kMostColumns;
  int rows = static_cast<int>(std::lround(columns * canvas.shape() / kRowOverColumn));
  if (rows > kMostRows) {
    rows = kMostRows;
    columns = static_cast<int>(std::lround(rows * kRowOverColumn / canvas.shape()));
  }
  rows = std::max(rows, 5);
  columns = std::max(columns, 13);
  std::vector<std::string> grid(static_cast<std::size_t>(rows),
                                std::string(static_cast<std::size_t>(columns), ' '));
  const auto column = [&](double x_m) {
    return static_cast<std::size_t>(std::lround(canvas.across(x_m) * (columns - 1)));
  };
  const auto row = [&](double y_m) {
    return static_cast<std::size_t>(std::lround(canvas.down(y_m) * (rows - 1)));
  };
  std::vector<std::string> names(static_cast<std::size_t>(rows));
  std::string foot(static_cast<std::size_t>(columns) + 4, ' ');
  for (int f = 0; f < s.frames(); ++f) {
    const double at = line_position(s, f);
    if (s.direction(f) == Direction::x) {
      for (char& c : grid[row(at)]) c = '-';
      names[row(at)] = s.frame_name(f);
    } else {
      for (std::string& line : grid) line[column(at)] = line[column(at)] == ' ' ? '|' : '+';
      foot.replace(column(at), s.frame_name(f).size(), s.frame_name(f));
    }
  }
  for (const DrawnSensor& sensor : a.sensors) {
    char& c = grid[row(sensor.at.y_m)][column(sensor.at.x_m)];
    c = c == '>' || c == '^' || c == '*' ? '*' : sensor.along == 'x' ? '>' : '^';
  }
  std::string out;
  for (std::size_t r = 0; r < grid.size(); ++r)
    out += fmt::format("  {:>4} {}\n", names[r], grid[r]);
  foot.erase(foot.find_last_not_of(' ') + 1);
  return foot.empty() ? out : out + fmt::format("  {:>4} {}\n", "", foot);
}

std::string arrow_svg(double x, double y, char along) {
  const double dx = along == 'x' ? 22 : 0, dy = along == 'x' ? 0 : -22;
  return fmt::format(
      "<path class=\"s\" d=\"M{:.1f} {:.1f}l{:.1f} {:.1f}\" marker-end=\"url(#a)\"/>"
      "<circle class=\"d\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"/>\n",
      x, y, dx, dy, x, y);
}

std::string text_svg(double x, double y, const std::string& text, const char* anchor = "start",
                     const char* kind = "t") {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n",
                     kind, x, y, anchor, html_text(text));
}

constexpr double kMargin = 24, kPlanWidth = 360, kElevation = 300, kLine = 17;

/// Returns the floors from the side, with the channels' names beside those that are measured.
std::string elevation_svg(const BuildingPlan& p, const std::vector<DrawnLevel>& levels,
                          double height) {
  const Structure& s = p.structure;
  constexpr double kHighestStory = 60;
  const double top = 60, left = kMargin + 46, width = 70;
  const double bottom = std::min(height - 40, top + kHighestStory * s.stories);
  const auto y_of = [&](int story) { return bottom - (bottom - top) * story / s.stories; };
  std::string out = text_svg(kMargin, 40, "Floors", "start", "h");
  for (int story = 0; story <= s.stories; ++story)
    out += fmt::format("<path class=\"f\" d=\"M{:.1f} {:.1f}h{}\"/>", left, y_of(story), width);
  out += fmt::format("<path class=\"f\" d=\"M{0:.1f} {1:.1f}V{2:.1f}M{3:.1f} {1:.1f}V{2:.1f}\"/>\n",
                     left, top, bottom, left + width);
  for (const DrawnLevel& level : levels) {
    std::string names;
    for (const DrawnSensor& sensor : level.sensors)
      names += (names.empty() ? "" : ", ") + sensor.name;
    constexpr std::size_t kMostLetters = 24;
    if (names.size() > kMostLetters) names = fmt::format("{} channels", level.sensors.size());
    out += fmt::format("<circle class=\"d\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\"/>",
                       left + width / 2, y_of(level.story));
    out += text_svg(left - 8, y_of(level.story) + 4, level_name(s, level.story), "end");
    out += text_svg(left + width + 8, y_of(level.story) + 4, names);
  }
  return out;
}

/// Returns the plan of an arrangement in the rectangle from (left, top); its height.
double arrangement_svg(const Structure& s, const Canvas& canvas, const Arrangement& a, double left,
                       double top, std::string& out) {
  const double width = kPlanWidth, height = width * std::clamp(canvas.shape(), 0.2, 1.2);
  const auto x_of = [&](double x_m) { return left + canvas.across(x_m) * width; };
  const auto y_of = [&](double y_m) { return top + 46 + canvas.down(y_m) * height; };
  out += text_svg(left - 20, top + 12, plan_title(s, a), "start", "h");
  for (int f = 0; f < s.frames(); ++f) {
    const double at = line_position(s, f);
    if (s.direction(f) == Direction::x) {
      out += fmt::format("<path class=\"f\" d=\"M{:.1f} {:.1f}h{:.1f}\"/>", left, y_of(at), width);
      out += text_svg(left - 6, y_of(at) + 4, s.frame_name(f), "end");
    } else {
      out += fmt::format("<path class=\"f\" d=\"M{:.1f} {:.1f}v{:.1f}\"/>", x_of(at), top + 46,
                         height);
      out += text_svg(x_of(at), top + 46 + height + 16, s.frame_name(f), "middle");
    }
  }
  std::vector<PlanPoint> named;
  for (const DrawnSensor& sensor : a.sensors) {
    const double x = x_of(sensor.at.x_m), y = y_of(sensor.at.y_m);
    const auto before = std::count(named.begin(), named.end(), sensor.at);
    named.push_back(sensor.at);
    out += arrow_svg(x, y, sensor.along);
    // Names stand inside the plan.
    const bool right = canvas.across(sensor.at.x_m) > 0.7;
    const bool low = canvas.down(sensor.at.y_m) > 0.8;
    const double line = kLine * static_cast<double>(before + 1);
    out += text_svg(x + (right ? -8 : 8), low ? y - line - 6 : y + line - 2, sensor.name,
                    right ? "end" : "start");
  }
  return height + 90;
}

}  // namespace

std::string plan_text(const BuildingPlan& p) {
  const std::vector<DrawnLevel> levels = drawn_levels(p);
  std::string out = "\nFloors, the top first, and their channels:\n";
  int above = p.structure.stories + 1;
  for (const DrawnLevel& level : levels) {
    if (above - level.story > 2)
      out += fmt::format("  {:>8}  none\n", fmt::format("{} to {}", above - 1, level.story + 1));
    else if (above - level.story == 2)
      out += fmt::format("  {:>8}  none\n", above - 1);
    above = level.story;
    std::string names;
    for (const DrawnSensor& sensor : level.sensors) names += " " + sensor.name;
    out += fmt::format("  {:>8} {}\n", level_name(p.structure, level.story), names);
  }
  const Canvas canvas(p.structure, levels);
  for (const Arrangement& a : arrangements(levels))
    out += fmt::format("\n{} (> along x, ^ along y, * several):\n{}", plan_title(p.structure, a),
                       grid_text(p.structure, canvas, a));
  return out + "\n";
}

std::string plan_svg(const BuildingPlan& p) {
  const std::vector<DrawnLevel> levels = drawn_levels(p);
  const Canvas canvas(p.structure, levels);
  std::string plans;
  double top = 28;
  const double left = kMargin + kElevation + 40;
  for (const Arrangement& a : arrangements(levels))
    top += arrangement_svg(p.structure, canvas, a, left, top, plans);
  constexpr double kLeastStory = 14;
  const double height = std::max({top, 120 + kLeastStory * p.structure.stories, 260.0});
  const double width = left + kPlanWidth + 2 * kMargin;
  return fmt::format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
             "viewBox=\"0 0 {0:.0f} {1:.0f}\">\n<title>{2}</title>\n"
             "<style>text{{font:12px sans-serif;fill:#222}}.h{{font-weight:bold}}"
             ".f{{stroke:#999;stroke-width:1.5;fill:none}}.s{{stroke:#0b57d0;stroke-width:2}}"
             ".d{{fill:#0b57d0}}</style>\n"
             "<defs><marker id=\"a\" viewBox=\"0 0 8 8\" refX=\"6\" refY=\"4\" markerWidth=\"5\" "
             "markerHeight=\"5\" orient=\"auto\"><path d=\"M0 0L8 4L0 8z\" fill=\"#0b57d0\"/>"
             "</marker></defs>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n",
             width, height, html_text(p.structure.name)) +
         elevation_svg(p, levels, height) + plans + "</svg>\n";
}

}  // namespace framewatch::daemon
