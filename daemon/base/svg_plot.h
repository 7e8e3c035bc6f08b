// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "estimator/identify/estimate/estimate.h"

namespace framewatch::daemon {

/// An axis of a plot.
struct SvgAxis {
  std::string label;                                      ///< quantity and unit: "stiffness, kN/m"
  double low = std::numeric_limits<double>::quiet_NaN();  ///< NaN takes it from the data
  double high = std::numeric_limits<double>::quiet_NaN();
  bool logarithmic = false;                  ///< only values > 0 are drawn
  std::vector<std::string> categories = {};  ///< names at 1, 2, ... instead of numbers
};

struct SvgTick {
  double value;
  std::string label;
};

/// Returns the axis with both ends set. A NaN end is set slightly beyond `values`, ignoring NaN and
/// infinity, or half a category beyond the first or last category.
SvgAxis fitted(SvgAxis axis, const std::vector<double>& values);

/// Returns about `wanted` round numbers between the ends: 1, 2 or 5 times a power of ten.
/// Logarithmic axes get powers of ten; categories get one tick each.
std::vector<SvgTick> ticks(const SvgAxis& axis, int wanted);

/// Returns the position of a value on a fitted axis: 0 at low, 1 at high, NaN if it cannot be
/// drawn.
double position(const SvgAxis& axis, double value);

/// Returns the CSS of plots: seven colors that are distinct without red-green vision (0 blue, 1
/// vermilion, 2 green, 3 purple, 4 orange, 5 sky, 6 gray), for light, dark and paper.
std::string svg_style();

/// How a series is drawn. Series differ by mark as well as by color, because color alone is not
/// enough.
enum class SvgMark { line, thin_line, dashed, dots, rings, bars };

/// Points of one plot. NaN breaks a line; a line with more points than pixels keeps its extremes.
struct SvgSeries {
  std::string name;  ///< in the legend; empty leaves it out
  int color = 0;     ///< 0..6, see svg_style()
  SvgMark mark = SvgMark::line;
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> error =
      {};                 ///< half length of the error bar at each point; empty for no bars
  std::string told = {};  ///< name in csv() of a series that the legend leaves out
};

/// A box as MATLAB's boxplot draws it, standing at x.
struct SvgBox {
  double x;
  estimator::BoxplotStatistics statistics;
  std::vector<double> outliers = {};
  int color = 0;
};

/// A plot as an inline SVG: axes with ticks, a grid, a legend, lines, dots and boxes. The same
/// input gives the same bytes. The page must hold svg_style() once (html_page() does).
///
///   SvgPlot plot("floor 2, frame y1", {"time, s"}, {"acceleration, m/s^2"});
///   plot.add({"measured", 0, SvgMark::line, time_s, measured, {}});
///   plot.add({"simulated", 1, SvgMark::dashed, time_s, simulated, {}});
///   html += plot.svg();
class SvgPlot {
 public:
  /// `width`, `height`: pixels at full size; the picture scales to the available space.
  SvgPlot(std::string title, SvgAxis x, SvgAxis y, int width = 640, int height = 280);

  void add(SvgSeries series) { series_.push_back(std::move(series)); }
  void add(SvgBox box) { boxes_.push_back(std::move(box)); }
  /// Sets what svg() tells readers who cannot see it, after the title.
  void describe(std::string text) { description_ = std::move(text); }
  /// Leaves out the axes and draws x and y in one scale, as in a drawing of a building.
  void leave_out_axes() { axes_ = false; }
  /// Adds a thin horizontal line across the plot.
  void add_rule(double y) { rules_.push_back(y); }

  std::string svg() const;

  /// Returns an SVG document for print, `width_mm` wide, without the title. Letters have 8 points
  /// at that size. Series keep apart in gray: their colors differ in lightness, their lines in
  /// dashes.
  std::string document(double width_mm) const;

  /// Returns the drawn points as CSV, one row each: the series, x and y with the labels of the
  /// axes, and, where the plot has them, the error and the statistic of a box.
  std::string csv() const;

  const std::string& title() const { return title_; }
  /// Returns the height of svg() and document(), pixels at 96 per inch.
  int height() const { return height_; }

 private:
  /// Returns the values that the y axis must hold, of all points within the x axis.
  std::vector<double> ys_within(const SvgAxis& x) const;
  std::string drawn(const std::string& head, int width, bool titled) const;

  std::string title_, description_;
  SvgAxis x_, y_;
  int width_, height_;
  bool axes_ = true;
  std::vector<SvgSeries> series_;
  std::vector<SvgBox> boxes_;
  std::vector<double> rules_;
};

/// A plot with the stable name of its files, such as "transfer-x".
struct Picture {
  std::string name;
  SvgPlot plot;
  std::string csv = {};  ///< the text of its CSV file; empty: SvgPlot::csv()
};

}  // namespace framewatch::daemon
