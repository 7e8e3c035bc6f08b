#include "daemon/base/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/html_text.h"

namespace framewatch::daemon {
namespace {

constexpr double kLeft = 72, kRight = 14, kBottom = 42, kTop = 10;  // px around the plotting area
constexpr double kFromEdge = 12;                                    // of the label beside it
constexpr double kLine = 17;                                        // px, title and legend
constexpr double kCharacter = 6.1;                                  // px, mean width in the legend
constexpr double kFar = 1e4;  // px: what lies further outside is cut before it is written

/// The plotting area: pixels of its own, clipped by a nested svg element.
struct Area {
  SvgAxis x, y;
  double left, top, width, height;

  double px(double value) const { return std::clamp(position(x, value) * width, -kFar, kFar); }
  double py(double value) const {
    return std::clamp((1 - position(y, value)) * height, -kFar, kFar);
  }
};

std::string line(const char* style, double x1, double y1, double x2, double y2) {
  return fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>",
                     style, x1, y1, x2, y2);
}

std::string text(const char* style, double x, double y, const std::string& content) {
  return fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", style, x, y,
                     html_text(content));
}

struct Pixel {
  double x, y;
};

/// Points of one pixel column become their first, extremes and last, when there are too many.
std::vector<Pixel> thinned(const std::vector<Pixel>& all, double width) {
  if (static_cast<double>(all.size()) < 4 * width) return all;
  std::vector<Pixel> out;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t end = i, low = i, high = i;
    for (; end < all.size() && std::floor(all[end].x) == std::floor(all[i].x); ++end) {
      if (all[end].y < all[low].y) low = end;
      if (all[end].y > all[high].y) high = end;
    }
    std::vector<std::size_t> keep{i, std::min(low, high), std::max(low, high), end - 1};
    keep.erase(std::unique(keep.begin(), keep.end()), keep.end());
    for (const std::size_t k : keep) out.push_back(all[k]);
    i = end;
  }
  return out;
}

std::string polyline(const std::vector<Pixel>& points, const char* style, int color) {
  if (points.size() < 2) return "";
  std::string out = fmt::format("<polyline class=\"{} s{}\" points=\"", style, color);
  for (const Pixel& p : points) out += fmt::format("{:.1f},{:.1f} ", p.x, p.y);
  out.back() = '"';
  return out + "/>";
}

std::string lines(const SvgSeries& s, const Area& a, const char* style) {
  std::string out;
  std::vector<Pixel> run;
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const Pixel p{a.px(s.x[i]), a.py(s.y[i])};
    if (std::isfinite(p.x) && std::isfinite(p.y)) {
      run.push_back(p);
      continue;
    }
    out += polyline(thinned(run, a.width), style, s.color);
    run.clear();
  }
  return out + polyline(thinned(run, a.width), style, s.color);
}

std::string mark(const SvgSeries& s, const Area& a, std::size_t i) {
  const double x = a.px(s.x[i]), y = a.py(s.y[i]);
  if (!std::isfinite(x) || !std::isfinite(y)) return "";
  std::string out;
  if (i < s.error.size() && std::isfinite(s.error[i])) {
    const double low = a.py(s.y[i] - s.error[i]), high = a.py(s.y[i] + s.error[i]);
    out +=
        fmt::format("<g class=\"l s{}\">{}{}{}</g>", s.color, line("l", x, low, x, high),
                    line("l", x - 2.5, low, x + 2.5, low), line("l", x - 2.5, high, x + 2.5, high));
  }
  if (s.mark == SvgMark::bars) {
    const double zero = std::clamp(a.py(0), 0.0, std::max(0.0, a.height));
    return out + fmt::format(
                     "<rect class=\"f{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"7\" "
                     "height=\"{:.1f}\"/>",
                     s.color, x - 3.5, std::min(y, zero), std::abs(zero - y));
  }
  return out + fmt::format("<circle class=\"{}{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>",
                           s.mark == SvgMark::rings ? "l s" : "f", s.color, x, y,
                           s.mark == SvgMark::rings ? "4" : "2.6");
}

const char* line_style(SvgMark mark) {
  return mark == SvgMark::thin_line ? "t" : mark == SvgMark::dashed ? "l d" : "l";
}

bool is_line(SvgMark mark) {
  return mark == SvgMark::line || mark == SvgMark::thin_line || mark == SvgMark::dashed;
}

std::string draw(const SvgSeries& s, const Area& a) {
  if (is_line(s.mark)) return lines(s, a, line_style(s.mark));
  std::string out;
  for (std::size_t i = 0; i < s.x.size(); ++i) out += mark(s, a, i);
  return out;
}

std::string draw(const SvgBox& b, const Area& a) {
  constexpr double kHalf = 6;
  const estimator::BoxplotStatistics& s = b.statistics;
  if (s.count == 0) return "";
  const double x = a.px(b.x), q1 = a.py(s.q1), q3 = a.py(s.q3);
  std::string out = fmt::format("<g class=\"l s{}\">", b.color);
  out += line("l", x, q1, x, a.py(s.whisker_low)) + line("l", x, q3, x, a.py(s.whisker_high));
  for (const double end : {s.whisker_low, s.whisker_high})
    out += line("l", x - kHalf / 2, a.py(end), x + kHalf / 2, a.py(end));
  out += fmt::format("<rect class=\"b\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{}\" height=\"{:.1f}\"/>",
                     x - kHalf, q3, 2 * kHalf, std::max(0.5, q1 - q3));
  out += line("m", x - kHalf, a.py(s.median), x + kHalf, a.py(s.median));
  for (const double value : b.outliers)
    out += fmt::format("<path class=\"l\" d=\"M{:.1f} {:.1f}h4m-2 -2v4\"/>", x - 2, a.py(value));
  return out + "</g>";
}

std::string frame(const Area& a) {
  std::string out;
  for (const SvgTick& t : ticks(a.y, std::max(2, static_cast<int>(a.height / 40)))) {
    out += line("g", 0, a.py(t.value), a.width, a.py(t.value));
    out += text("ye", -6, a.py(t.value) + 3.5, t.label);
  }
  const bool named = !a.x.categories.empty();
  std::size_t longest = 0;
  for (const std::string& name : a.x.categories) longest = std::max(longest, name.size());
  const double room = a.width / std::max<double>(1, static_cast<double>(a.x.categories.size()));
  const bool upright = kCharacter * static_cast<double>(longest) < room;
  for (const SvgTick& t : ticks(a.x, std::max(2, static_cast<int>(a.width / 70)))) {
    const double x = a.px(t.value);
    if (!named) out += line("g", x, 0, x, a.height);
    if (named && !upright)
      out += fmt::format(
          "<text class=\"ye\" transform=\"translate({:.1f} {:.1f}) rotate(-60)\">{}"
          "</text>",
          x + 4, a.height + 12, html_text(t.label));
    else
      out += text("xe", x, a.height + 14, t.label);
  }
  return out;
}

/// Sample of a series in the legend, 18 px wide, then its name.
std::string legend_entry(const SvgSeries& s, double x, double y) {
  if (is_line(s.mark))
    return fmt::format("<g class=\"s{}\">{}</g>", s.color,
                       line(line_style(s.mark), x, y - 4, x + 16, y - 4)) +
           text("le", x + 21, y, s.name);
  SvgSeries one{"", s.color, s.mark, {0}, {1}, {}};
  const Area a{{"", 0, 1, false, {}}, {"", 0, 1, false, {}}, 0, 0, 1, 8};
  return fmt::format("<g transform=\"translate({:.1f} {:.1f})\">{}</g>", x + 8,
                     y - 8 + (s.mark == SvgMark::bars ? 0 : 4), mark(one, a, 0)) +
         text("le", x + 21, y, s.name);
}

}  // namespace

SvgPlot::SvgPlot(std::string title, SvgAxis x, SvgAxis y, int width, int height)
    : title_(std::move(title)),
      x_(std::move(x)),
      y_(std::move(y)),
      width_(width),
      height_(height) {}

std::string SvgPlot::svg() const {
  std::vector<double> xs, ys = rules_;
  for (const SvgSeries& s : series_) {
    xs.insert(xs.end(), s.x.begin(), s.x.end());
    ys.insert(ys.end(), s.y.begin(), s.y.end());
    for (std::size_t i = 0; i < s.error.size(); ++i)
      for (const double end : {s.y[i] - s.error[i], s.y[i] + s.error[i]}) ys.push_back(end);
    if (s.mark == SvgMark::bars) ys.push_back(0);
  }
  for (const SvgBox& b : boxes_) {
    if (b.statistics.count == 0) continue;
    xs.push_back(b.x);
    ys.insert(ys.end(), {b.statistics.whisker_low, b.statistics.whisker_high});
    ys.insert(ys.end(), b.outliers.begin(), b.outliers.end());
  }
  std::string legend;
  double x = kLeft, top = kTop + (title_.empty() ? 0 : kLine);
  for (const SvgSeries& s : series_) {
    if (s.name.empty()) continue;
    const double wide = 34 + kCharacter * static_cast<double>(s.name.size());
    if (legend.empty()) top += kLine;
    if (x > kLeft && x + wide > width_ - kRight) {
      x = kLeft;
      top += kLine;
    }
    legend += legend_entry(s, x, top - 5);
    x += wide;
  }
  std::size_t longest = 0;
  for (const std::string& name : x_.categories) longest = std::max(longest, name.size());
  const double across = width_ - kLeft - kRight;
  const bool slanted = kCharacter * static_cast<double>(longest * x_.categories.size()) > across;
  const double below = kBottom + (slanted ? 5 * static_cast<double>(longest) - 8 : 0) -
                       (x_.label.empty() ? kLine : 0);
  const Area a{fitted(x_, xs), fitted(y_, ys), kLeft, top, across, height_ - top - below};

  std::string out = fmt::format(
      "<svg class=\"plot\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
      "aria-label=\"{2}\">",
      width_, height_, html_text(title_.empty() ? a.y.label : title_));
  if (!title_.empty()) out += text("ti", kLeft, kTop + 5, title_);
  out += legend;
  out += fmt::format("<g transform=\"translate({:.1f} {:.1f})\">", a.left, a.top) + frame(a);
  out += fmt::format("<svg width=\"{:.1f}\" height=\"{:.1f}\" overflow=\"hidden\">", a.width,
                     a.height);
  for (const double rule : rules_) out += line("r", 0, a.py(rule), a.width, a.py(rule));
  for (const SvgBox& b : boxes_) out += draw(b, a);
  for (const SvgSeries& s : series_) out += draw(s, a);
  out += "</svg>";
  out += fmt::format("<rect class=\"o\" width=\"{:.1f}\" height=\"{:.1f}\"/>", a.width, a.height);
  out += text("xe", a.width / 2, a.height + below - 8, a.x.label);
  out += fmt::format("<text class=\"xe\" transform=\"translate({} {:.1f}) rotate(-90)\">{}</text>",
                     kFromEdge - kLeft, a.height / 2, html_text(a.y.label));
  return out + "</g></svg>\n";
}

}  // namespace framewatch::daemon
