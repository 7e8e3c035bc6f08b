#pragma once

#include <string>
#include <utility>
#include <vector>

#include "daemon/base/svg_axis.h"
#include "estimator/identify/estimate/estimate.h"

namespace framewatch::daemon {

/// How a series is drawn. Series differ by mark as well as by colour: colour alone is not enough.
enum class SvgMark { line, thin_line, dashed, dots, rings, bars };

/// Points of one plot. NaN breaks a line; a line with more points than pixels keeps its extremes.
struct SvgSeries {
  std::string name;  ///< in the legend; empty: not in it
  int color = 0;     ///< 0..6, see svg_style()
  SvgMark mark = SvgMark::line;
  std::vector<double> x;
  std::vector<double> y;
  std::vector<double> error = {};  ///< half length of an error bar at each point; empty: none
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
  /// width, height: in pixels at full size; the picture scales to the room it is given.
  SvgPlot(std::string title, SvgAxis x, SvgAxis y, int width = 640, int height = 280);

  void add(SvgSeries series) { series_.push_back(std::move(series)); }
  void add(SvgBox box) { boxes_.push_back(std::move(box)); }
  /// A thin horizontal line across the plot.
  void add_rule(double y) { rules_.push_back(y); }

  std::string svg() const;

 private:
  std::string title_;
  SvgAxis x_, y_;
  int width_, height_;
  std::vector<SvgSeries> series_;
  std::vector<SvgBox> boxes_;
  std::vector<double> rules_;
};

}  // namespace framewatch::daemon
