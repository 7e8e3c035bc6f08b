// SPDX-License-Identifier: MIT
#include "daemon/base/svg_plot.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/printable.h"

namespace framewatch::daemon {
namespace {

constexpr double kMargin = 0.04;  ///< beyond the data, share of their range

/// Returns the largest step of 1, 2 or 5 times a power of ten with at least `wanted` steps in a
/// range.
double round_step(double range, int wanted) {
  const double raw = range / wanted;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= raw) return factor * power;
  return power;
}

std::string number(double value, double step) {
  const double size = std::max(std::abs(value), step);
  if (size >= 1e6 || step < 1e-5) return fmt::format("{:.6g}", value);
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  return fmt::format("{:.{}f}", std::abs(value) < 1e-9 * step ? 0.0 : value, decimals);
}

std::vector<SvgTick> powers_of_ten(const SvgAxis& axis, int wanted) {
  const int first = static_cast<int>(std::ceil(std::log10(axis.low) - 1e-9));
  const int last = static_cast<int>(std::floor(std::log10(axis.high) + 1e-9));
  const int every = std::max(1, (last - first + wanted) / wanted);
  std::vector<SvgTick> out;
  for (int power = first; power <= last; power += every) {
    const double value = std::pow(10.0, power);
    out.push_back(
        {value, std::abs(power) <= 4 ? fmt::format("{:g}", value) : fmt::format("1e{}", power)});
  }
  return out;
}

/// Colors of Okabe and Ito, which also differ in lightness; brighter variants on black.
constexpr const char* kLight[] = {"#0072b2", "#d55e00", "#009e73", "#aa4499",
                                  "#b27d00", "#3d9ad1", "#7f7f7f"};
constexpr const char* kDark[] = {"#4da6e8", "#ff8c42", "#2fce9f", "#e39bd0",
                                 "#f2b93b", "#8fd3fb", "#a0a0a0"};

std::string variables(const char* const (&colors)[7], const char* grid) {
  std::string out = fmt::format("--grid:{};", grid);
  for (int i = 0; i < 7; ++i) out += fmt::format("--s{}:{};", i, colors[i]);
  return out;
}

/// Colors for print. Those that meet in one plot differ by at least 30 of 255 in gray.
constexpr const char* kPrint[] = {"#00457c", "#e07b39", "#006b45", "#dcb4d8",
                                  "#8a5a00", "#9fcbe6", "#b4b4b4"};
/// Dashes of the lines of series 1 to 3; series 0 is solid.
constexpr const char* kDashes[] = {"7 2", "2 1.5", "7 2 1.5 2"};

constexpr const char* kMarks =
    ".plot{max-width:100%;height:auto;font:11px system-ui,sans-serif;color:inherit}"
    ".plot text{fill:currentColor}.plot .ti{font-weight:600;font-size:12px}"
    ".plot .ye{text-anchor:end}.plot .xe{text-anchor:middle}"
    ".plot .g{stroke:var(--grid);stroke-width:1}"
    ".plot .o{fill:none;stroke:currentColor;stroke-width:.8;stroke-opacity:.6}"
    ".plot .r{stroke:currentColor;stroke-width:1;stroke-dasharray:2 3;stroke-opacity:.7}"
    ".plot .l{fill:none;stroke-width:1.6}.plot .t{fill:none;stroke-width:.8;stroke-opacity:.75}"
    ".plot .d{stroke-dasharray:6 4}"
    ".plot .b{fill:var(--page);stroke-width:1.2}.plot .m{stroke-width:2.4}";

constexpr double kLeft = 72, kRight = 14, kBottom = 42, kTop = 10;  // px around the plotting area
constexpr double kFromEdge = 12;                                    // of the label beside it
constexpr double kLine = 17;                                        // px, title and legend
constexpr double kCharacter = 6.1;                                  // px, mean width in the legend
constexpr double kFar = 1e4;  // px; points farther outside are clipped

/// The plotting area. A nested svg element with separate pixel coordinates clips it.
struct Area {
  SvgAxis x, y;
  double left, top, width, height;
  double bar = 7;  ///< width of a bar

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

/// Reduces too many points of one pixel column to the first, the extremes and the last.
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
                     "<rect class=\"f{}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.2g}\" "
                     "height=\"{:.1f}\"/>",
                     s.color, x - a.bar / 2, std::min(y, zero), a.bar, std::abs(zero - y));
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

/// Draws a sample of a series in the legend, 18 px wide, then its name.
std::string legend_entry(const SvgSeries& s, double x, double y) {
  if (is_line(s.mark))
    return polyline({{x, y - 4}, {x + 16, y - 4}}, line_style(s.mark), s.color) +
           text("le", x + 21, y, s.name);
  SvgSeries one{"", s.color, s.mark, {0}, {1}, {}};
  const Area a{{"", 0, 1, false, {}}, {"", 0, 1, false, {}}, 0, 0, 1, 8};
  return fmt::format("<g transform=\"translate({:.1f} {:.1f})\">{}</g>", x + 8,
                     y - 8 + (s.mark == SvgMark::bars ? 0 : 4), mark(one, a, 0)) +
         text("le", x + 21, y, s.name);
}

constexpr double kOfSpacing = 0.85;  ///< width of a bar, share of the space to the next one

/// Returns the least distance between two places of bars, px.
double least_spacing(std::vector<double> bars, const Area& a) {
  std::sort(bars.begin(), bars.end());
  double least = INFINITY;
  for (std::size_t i = 1; i < bars.size(); ++i)
    if (const double apart = a.px(bars[i]) - a.px(bars[i - 1]); apart > 1e-3)
      least = std::min(least, apart);
  return least;
}

/// Returns `text` with every `from` replaced by `to`.
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// Returns the style of a document for print: kMarks without variables, which only browsers know.
std::string print_style() {
  std::string out = replaced(replaced(kMarks, "var(--grid)", "#dcdcdc"), "var(--page)", "#fff");
  out = replaced(replaced(out, "currentColor", "#000"), "font:11px system-ui,sans-serif;",
                 "font-family:Helvetica,Arial,'Liberation Sans','DejaVu Sans',sans-serif;"
                 "font-size:10.7px;");
  for (int i = 0; i < 7; ++i)
    out += fmt::format(".plot .s{0}{{stroke:{1}}}.plot .f{0}{{fill:{1}}}", i, kPrint[i]);
  for (int i = 1; i <= 3; ++i)
    out += fmt::format(".plot polyline.l.s{}{{stroke-dasharray:{}}}", i, kDashes[i - 1]);
  return out +
         ".plot polyline.d{stroke-dasharray:4 3}.plot rect.f0,.plot rect.f1,.plot rect.f2,"
         ".plot rect.f3,.plot rect.f4,.plot rect.f5,.plot rect.f6{stroke:#000;"
         "stroke-width:.4}";
}

/// Returns "time (s)" for the axis label "time, s".
std::string column_title(const std::string& label, const char* otherwise) {
  if (label.empty()) return otherwise;
  const std::size_t comma = label.rfind(", ");
  return comma == std::string::npos
             ? label
             : fmt::format("{} ({})", label.substr(0, comma), label.substr(comma + 2));
}

/// Widens one axis about its middle, so that both have one scale.
void use_one_scale(Area& a) {
  const double of_x = (a.x.high - a.x.low) / a.width, of_y = (a.y.high - a.y.low) / a.height;
  SvgAxis& axis = of_x < of_y ? a.x : a.y;
  const double range = of_x < of_y ? of_y * a.width : of_x * a.height;
  const double more = (range - (axis.high - axis.low)) / 2;
  axis.low -= more;
  axis.high += more;
}

}  // namespace

SvgAxis fitted(SvgAxis axis, const std::vector<double>& values) {
  double low = INFINITY, high = -INFINITY;
  for (const double value : values) {
    if (!std::isfinite(value) || (axis.logarithmic && value <= 0)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!axis.categories.empty()) {
    low = 0.5;
    high = static_cast<double>(axis.categories.size()) + 0.5;
  } else if (low > high) {
    low = axis.logarithmic ? 0.1 : 0.0;
    high = 1;
  } else if (axis.logarithmic) {
    low /= 1.5;
    high *= 1.5;
  } else {
    if (!std::isnan(axis.low)) low = axis.low;
    if (!std::isnan(axis.high)) high = axis.high;
    const double range = high > low ? high - low : std::max(1e-12, std::abs(high));
    low -= kMargin * range;
    high += kMargin * range;
  }
  if (std::isnan(axis.low)) axis.low = low;
  if (std::isnan(axis.high)) axis.high = high;
  if (!(axis.high > axis.low)) axis.high = axis.low + std::max(1e-12, std::abs(axis.low));
  return axis;
}

std::vector<SvgTick> ticks(const SvgAxis& axis, int wanted) {
  std::vector<SvgTick> out;
  if (!axis.categories.empty()) {
    for (std::size_t i = 0; i < axis.categories.size(); ++i)
      out.push_back({static_cast<double>(i + 1), axis.categories[i]});
    return out;
  }
  if (axis.logarithmic) return powers_of_ten(axis, wanted);
  const double step = round_step(axis.high - axis.low, wanted);
  const double first = std::ceil(axis.low / step - 1e-9);
  const double last = std::floor(axis.high / step + 1e-9);
  for (double i = first; i <= last; ++i) out.push_back({i * step, number(i * step, step)});
  return out;
}

double position(const SvgAxis& axis, double value) {
  if (!axis.logarithmic) return (value - axis.low) / (axis.high - axis.low);
  return value > 0 ? std::log(value / axis.low) / std::log(axis.high / axis.low)
                   : std::numeric_limits<double>::quiet_NaN();
}

std::string svg_style() {
  const std::string light = variables(kLight, "#e4e4e4"), dark = variables(kDark, "#3a3a3a");
  std::string out = fmt::format(
      ":root{{{}}}@media screen and (prefers-color-scheme:dark){{:root{{{}}}}}", light, dark);
  out += kMarks;
  for (int i = 0; i < 7; ++i)
    out += fmt::format(".plot .s{0}{{stroke:var(--s{0})}}.plot .f{0}{{fill:var(--s{0})}}", i);
  return out;
}

SvgPlot::SvgPlot(std::string title, SvgAxis x, SvgAxis y, int width, int height)
    : title_(std::move(title)),
      x_(std::move(x)),
      y_(std::move(y)),
      width_(width),
      height_(height) {}

std::string SvgPlot::svg() const {
  const std::string head = fmt::format(
      "<svg class=\"plot\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\" "
      "aria-label=\"{2}\">",
      width_, height_,
      html_text((title_.empty() ? y_.label : title_) +
                (description_.empty() ? "" : ". " + description_)));
  return drawn(head, width_, true) + "\n";
}

std::string SvgPlot::document(double width_mm) const {
  constexpr double kPixelsPerMm = 96 / 25.4;
  const int width = static_cast<int>(std::lround(width_mm * kPixelsPerMm));
  const std::string head = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"plot\" viewBox=\"0 0 {0} {1}\" "
      "width=\"{2:.2f}mm\" height=\"{3:.2f}mm\"><title>{4}</title><style>{5}</style>",
      width, height_, width_mm, height_ / kPixelsPerMm,
      html_text(title_.empty() ? y_.label : title_), print_style());
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n" + drawn(head, width, false) + "\n";
}

std::string SvgPlot::csv() const {
  bool errors = false;
  for (const SvgSeries& s : series_) errors = errors || !s.error.empty();
  std::string out = "series," + csv_text(column_title(x_.label, "x")) + "," +
                    csv_text(column_title(y_.label, "y")) + (errors ? ",standard error" : "") +
                    (boxes_.empty() ? "" : ",statistic") + "\n";
  const auto add = [&](const std::string& series, double x, double y, double error,
                       const char* statistic) {
    if (!std::isfinite(x) || (!boxes_.empty() && !std::isfinite(y))) return;
    const auto place = static_cast<std::size_t>(std::lround(std::max(x, 1.0))) - 1;
    const std::string row =
        csv_text(series) + "," +
        (place < x_.categories.size() ? csv_text(x_.categories[place]) : csv_number(x)) + "," +
        csv_number(y) + (errors ? "," + csv_number(error) : "") +
        (boxes_.empty() ? "" : std::string(",") + statistic) + "\n";
    if (!out.ends_with("\n" + row)) out += row;  // both ends of a dash across its category
  };
  for (const SvgSeries& s : series_)
    for (std::size_t i = 0; i < s.x.size(); ++i)
      add(s.name.empty() ? s.told : s.name, s.x[i], s.y[i],
          i < s.error.size() ? s.error[i] : std::numeric_limits<double>::quiet_NaN(), "");
  for (const SvgBox& b : boxes_) {
    if (b.statistics.count == 0) continue;
    std::string series;
    for (const SvgSeries& s : series_)
      if (s.color == b.color && series.empty()) series = s.name;
    const auto one = [&](const char* statistic, double y) {
      add(series, b.x, y, std::numeric_limits<double>::quiet_NaN(), statistic);
    };
    one("lower whisker", b.statistics.whisker_low);
    one("lower quartile", b.statistics.q1);
    one("median", b.statistics.median);
    one("upper quartile", b.statistics.q3);
    one("upper whisker", b.statistics.whisker_high);
    for (const double value : b.outliers) one("outlier", value);
  }
  return out;
}

std::vector<double> SvgPlot::ys_within(const SvgAxis& x) const {
  std::vector<double> ys = rules_;
  for (const SvgSeries& s : series_) {
    for (std::size_t i = 0; i < s.y.size(); ++i) {
      if (!(s.x[i] >= x.low && s.x[i] <= x.high)) continue;
      ys.push_back(s.y[i]);
      if (i < s.error.size()) ys.insert(ys.end(), {s.y[i] - s.error[i], s.y[i] + s.error[i]});
    }
    if (s.mark == SvgMark::bars) ys.push_back(0);
  }
  for (const SvgBox& b : boxes_) {
    if (b.statistics.count == 0) continue;
    ys.insert(ys.end(), {b.statistics.whisker_low, b.statistics.whisker_high});
    ys.insert(ys.end(), b.outliers.begin(), b.outliers.end());
  }
  return ys;
}

std::string SvgPlot::drawn(const std::string& head, int width, bool titled) const {
  std::vector<double> xs, bars;
  for (const SvgSeries& s : series_) {
    xs.insert(xs.end(), s.x.begin(), s.x.end());
    if (s.mark == SvgMark::bars) bars.insert(bars.end(), s.x.begin(), s.x.end());
  }
  for (const SvgBox& b : boxes_)
    if (b.statistics.count > 0) xs.push_back(b.x);
  std::string legend;
  titled = titled && !title_.empty();
  const double left = axes_ ? kLeft : kTop;
  double x = left, top = kTop + (titled ? kLine : 0);
  for (const SvgSeries& s : series_) {
    if (s.name.empty()) continue;
    const double wide = 34 + kCharacter * static_cast<double>(s.name.size());
    if (legend.empty()) top += kLine;
    if (x > left && x + wide > width - kRight) {
      x = left;
      top += kLine;
    }
    legend += legend_entry(s, x, top - 5);
    x += wide;
  }
  std::size_t longest = 0;
  for (const std::string& name : x_.categories) longest = std::max(longest, name.size());
  const double across = width - left - kRight;
  const bool slanted = kCharacter * static_cast<double>(longest * x_.categories.size()) > across;
  const double below = axes_ ? kBottom + (slanted ? 5 * static_cast<double>(longest) - 8 : 0) -
                                   (x_.label.empty() ? kLine : 0)
                             : kTop;
  Area a{fitted(x_, xs),       fitted(y_, ys_within(fitted(x_, xs))), left, top, across,
         height_ - top - below};
  if (!axes_) use_one_scale(a);
  a.bar = std::min(a.bar, kOfSpacing * least_spacing(bars, a));

  std::string out = head;
  if (titled) out += text("ti", left, kTop + 5, title_);
  out += legend;
  out += fmt::format("<g transform=\"translate({:.1f} {:.1f})\">", a.left, a.top);
  if (axes_) out += frame(a);
  out += fmt::format("<svg width=\"{:.1f}\" height=\"{:.1f}\" overflow=\"hidden\">", a.width,
                     a.height);
  for (const double rule : rules_) out += line("r", 0, a.py(rule), a.width, a.py(rule));
  for (const SvgBox& b : boxes_) out += draw(b, a);
  for (const SvgSeries& s : series_) out += draw(s, a);
  out += "</svg>";
  if (!axes_) return out + "</g></svg>";
  out += fmt::format("<rect class=\"o\" width=\"{:.1f}\" height=\"{:.1f}\"/>", a.width, a.height);
  out += text("xe", a.width / 2, a.height + below - 8, a.x.label);
  out += fmt::format("<text class=\"xe\" transform=\"translate({} {:.1f}) rotate(-90)\">{}</text>",
                     kFromEdge - kLeft, a.height / 2, html_text(a.y.label));
  return out + "</g></svg>";
}

}  // namespace framewatch::daemon
