// SPDX-License-Identifier: MIT
#include "daemon/tools/diagnosis/where_map.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <fmt/core.h>

#include "daemon/base/html_page.h"

namespace framewatch::daemon {
namespace {

constexpr double kPlan = 150, kMargin = 34;  ///< pixels: longest side of a plan, and around it
constexpr double kNumber = 12;               ///< pixels between a mark and its number
constexpr double kFaint = 0.15;
constexpr std::size_t kNumbered = 3;

std::vector<double> lines_at(const std::vector<double>& spans) {
  std::vector<double> out{0};
  for (const double span : spans) out.push_back(out.back() + span);
  return out;
}

class Plans {
 public:
  Plans(const estimator::Structure& s, const std::vector<estimator::SensorAxis>& axes,
        const std::vector<estimator::WhereEntry>& map, double ratio_before)
      : s_(s), axes_(axes), map_(map), before_(ratio_before) {
    x_ = lines_at(s.span_x);
    y_ = lines_at(s.span_y);
    const double longest = std::max({x_.back(), y_.back(), 1e-9});
    for (double& v : x_) v *= kPlan / longest;
    for (double& v : y_) v *= kPlan / longest;
    for (const estimator::WhereEntry& e : map)
      if (numbered_.size() < kNumbered && on_plan(e.place)) numbered_.push_back(e.place);
  }

  std::string plan(int story) {
    out_.clear();
    const double width = std::max(x_.back(), kPlan / 2) + 2 * kMargin;
    const double height = std::max(y_.back(), kPlan / 4) + 2 * kMargin;
    out_ += fmt::format(
        "<svg class=\"plot\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
        "role=\"img\"><title>{2}</title><text class=\"ti\" x=\"4\" y=\"14\">{2}</text>",
        width, height, story > 0 ? fmt::format("story and floor {}", story) : "base");
    if (story > 0) draw_panels(story);
    for (int f = 0; f < s_.frames(); ++f) draw_frame(story, f);
    if (story > 0) draw_crossings(story);
    draw_sensors(story);
    return out_ + "</svg>";
  }

 private:
  /// Returns 0 for a place that explains nothing, 1 for the best place.
  double strength(const estimator::WhereEntry& e) const {
    const double most = std::log(before_ / map_.front().ratio);
    return most > 0 ? std::clamp(std::log(before_ / e.ratio) / most, 0.0, 1.0) : 0;
  }

  static bool on_plan(const estimator::EffectPlace& p) {
    return p.kind == estimator::PlaceKind::frame || p.kind == estimator::PlaceKind::node ||
           p.kind == estimator::PlaceKind::panel || p.kind == estimator::PlaceKind::crossing ||
           p.kind == estimator::PlaceKind::channel;
  }

  template <typename Is>
  const estimator::WhereEntry* find(const Is& is) const {
    const auto at = std::find_if(map_.begin(), map_.end(),
                                 [&](const estimator::WhereEntry& e) { return is(e.place); });
    return at == map_.end() ? nullptr : &*at;
  }

  /// Returns the entry of a frame at a story. A force on the frame at that floor counts as the
  /// frame.
  const estimator::WhereEntry* of_frame(int story, int frame) const {
    return find([&](const estimator::EffectPlace& p) {
      return (p.kind == estimator::PlaceKind::frame || p.kind == estimator::PlaceKind::node) &&
             p.story == story && p.frame == frame;
    });
  }

  void number(const estimator::WhereEntry* e, double x, double y) {
    if (e == nullptr) return;
    const auto at = std::find(numbered_.begin(), numbered_.end(), e->place);
    if (at != numbered_.end())
      out_ += fmt::format("<text class=\"ti xe\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", x, y + 4,
                          at - numbered_.begin() + 1);
  }

  double screen_x(double x) const { return kMargin + x; }
  double screen_y(double y) const { return kMargin + y_.back() - y; }

  void draw_panels(int story) {
    for (std::size_t j = 0; j + 1 < y_.size() && s_.panels() > 0; ++j)
      for (std::size_t i = 0; i + 1 < x_.size(); ++i) {
        const auto panel = static_cast<int>(j * (x_.size() - 1) + i);
        const estimator::WhereEntry* e = find([&](const estimator::EffectPlace& p) {
          return p.kind == estimator::PlaceKind::panel && p.story == story && p.panel == panel;
        });
        const double w = x_[i + 1] - x_[i], h = y_[j + 1] - y_[j];
        out_ += fmt::format(
            "<rect class=\"f1\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
            "fill-opacity=\"{:.2f}\"/>",
            screen_x(x_[i]) + 0.2 * w, screen_y(y_[j + 1]) + 0.2 * h, 0.6 * w, 0.6 * h,
            e != nullptr ? 0.05 + 0.8 * strength(*e) : 0.05);
        number(e, screen_x(x_[i] + w / 2), screen_y(y_[j] + h / 2));
      }
  }

  void draw_frame(int story, int f) {
    const bool along_x = s_.direction(f) == estimator::Direction::x;
    const double at =
        along_x ? y_[static_cast<std::size_t>(f)] : x_[static_cast<std::size_t>(f - s_.n())];
    const double length = std::max(along_x ? x_.back() : y_.back(), kPlan / 4);
    const double x0 = screen_x(along_x ? 0 : at), y0 = screen_y(along_x ? at : 0);
    const double x1 = along_x ? x0 + length : x0, y1 = along_x ? y0 : y0 - length;
    const estimator::WhereEntry* e = story > 0 ? of_frame(story, f) : nullptr;
    const double s = e != nullptr ? strength(*e) : 0;
    out_ += fmt::format(
        "<line class=\"g\" x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{2:.1f}\" y2=\"{3:.1f}\"/><line "
        "class=\"s1\" x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{2:.1f}\" y2=\"{3:.1f}\" "
        "stroke-width=\"{4:.1f}\" stroke-opacity=\"{5:.2f}\"/>",
        x0, y0, x1, y1, 1 + 6 * s, kFaint + (1 - kFaint) * s);
    out_ +=
        fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", along_x ? "ye" : "xe",
                    along_x ? x0 - 8 : x0, along_x ? y0 + 4 : y0 + 20, html_text(s_.frame_name(f)));
    number(e, (x0 + x1) / 2 + (along_x ? 0 : kNumber), (y0 + y1) / 2 - (along_x ? kNumber : 0));
  }

  void draw_crossings(int story) {
    const auto columns = x_.size();
    for (std::size_t c = 0; c < columns * y_.size(); ++c) {
      const estimator::WhereEntry* e = find([&](const estimator::EffectPlace& p) {
        return p.kind == estimator::PlaceKind::crossing && p.story == story &&
               p.crossing == static_cast<int>(c);
      });
      if (e == nullptr) continue;
      const double x = screen_x(x_[c % columns]), y = screen_y(y_[c / columns]);
      out_ += fmt::format(
          "<rect class=\"f1\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"8\" height=\"8\" "
          "fill-opacity=\"{:.2f}\"/>",
          x - 4, y - 4, kFaint + (1 - kFaint) * strength(*e));
      number(e, x - kNumber, y - kNumber);
    }
  }

  /// Returns the far end of the frame that the axis is on; the middle for axes of the whole base.
  void draw_sensors(int story) {
    double along = screen_x(x_.back() / 2);
    for (std::size_t a = 0; a < axes_.size(); ++a) {
      const estimator::SensorAxis& axis = axes_[a];
      if (axis.story != story) continue;
      double x = along, y = screen_y(y_.back() / 2);
      if (axis.frame >= 0 && s_.direction(axis.frame) == estimator::Direction::x) {
        x = screen_x(std::max(x_.back(), kPlan / 4)) + 14;
        y = screen_y(y_[static_cast<std::size_t>(axis.frame)]);
      } else if (axis.frame >= 0) {
        x = screen_x(x_[static_cast<std::size_t>(axis.frame - s_.n())]);
        y = screen_y(std::max(y_.back(), kPlan / 4)) - 10;
      } else {
        along += 2 * kNumber;
      }
      const estimator::WhereEntry* e = find([&](const estimator::EffectPlace& p) {
        return p.kind == estimator::PlaceKind::channel && p.channel == static_cast<int>(a);
      });
      out_ += fmt::format(
          "<circle class=\"f1 s1\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" "
          "fill-opacity=\"{:.2f}\"><title>{}</title></circle>",
          x, y, e != nullptr ? strength(*e) : 0, html_text(axis.name));
      number(e, x + kNumber, y - 3);
    }
  }

  const estimator::Structure& s_;
  const std::vector<estimator::SensorAxis>& axes_;
  const std::vector<estimator::WhereEntry>& map_;
  double before_;
  std::vector<double> x_, y_;  ///< places of the lines, pixels
  std::vector<estimator::EffectPlace> numbered_;
  std::string out_;
};

}  // namespace

std::vector<std::string> where_map(const estimator::Structure& structure,
                                   const std::vector<estimator::SensorAxis>& axes,
                                   const std::vector<estimator::WhereEntry>& map,
                                   double ratio_before) {
  std::vector<std::string> out;
  if (map.empty()) return out;
  Plans plans(structure, axes, map, ratio_before);
  for (int story = structure.stories; story >= 0; --story) out.push_back(plans.plan(story));
  return out;
}

}  // namespace framewatch::daemon
