// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/svg_plot.h"
#include "daemon/base/words.h"
#include "daemon/monitor/estimates/parameter_summary.h"
#include "daemon/tools/report/session_report.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxHistories = 48, kMaxLoops = 32;
constexpr Eigen::Index kMaxLoopPoints = 1000;

std::string motion_plot(const SessionReport& r, bool base) {
  const SessionMotion& m = *r.motion;
  const int story = base ? 0 : r.config->pipeline.structure.stories;
  SvgPlot plot(base ? "base" : fmt::format("floor {}", story), {"time, s"}, {"acceleration, m/s^2"},
               980, 170);
  std::vector<double> t;
  for (Eigen::Index i = 0; i < m.accel.rows(); ++i) t.push_back(session_seconds(r, m.time_us(i)));
  int color = 0;
  for (std::size_t a = 0; a < m.axes.size() && color < 4; ++a) {
    if (m.axes[a].story != story || !m.axes[a].horizontal()) continue;
    const auto column = m.accel.col(static_cast<Eigen::Index>(a));
    plot.add(
        SvgSeries{m.axes[a].name, color++, SvgMark::thin_line, t, {column.begin(), column.end()}});
  }
  return plot.svg();
}

/// Limits the axis to 98 % of the values and, if it is near, the reference, so that a few windows
/// at the end of a free vibration do not flatten all the others.
SvgAxis without_spikes(SvgAxis axis, std::vector<double> values, double reference) {
  std::erase_if(values, [](double value) { return !std::isfinite(value); });
  if (values.empty()) return axis;
  std::sort(values.begin(), values.end());
  double low = values[values.size() / 100], high = values[values.size() - 1 - values.size() / 100];
  const double middle = values[values.size() / 2];
  if (std::abs(reference - middle) < 0.5 * middle) {
    low = std::min(low, reference);
    high = std::max(high, reference);
  }
  const double room = std::max(0.15 * (high - low), 0.01 * std::abs(middle));
  axis.low = low - room;
  axis.high = high + room;
  return axis;
}

/// Plots a parameter with one standard error to either side over time.
std::string history(const SessionReport& r, std::size_t p, const std::vector<double>& t) {
  const auto [factor, unit] = paper_unit(r.estimates.table.kind[p]);
  const auto& value = r.estimates.value[p];
  std::vector<double> v, low, high;
  for (std::size_t w = 0; w < value.size(); ++w) {
    v.push_back(factor * value[w]);
    low.push_back(factor * (value[w] - r.estimates.std_error[p][w]));
    high.push_back(factor * (value[w] + r.estimates.std_error[p][w]));
  }
  const double reference = factor * r.reference_static[p];
  const SvgAxis y = without_spikes({unit}, v, reference);
  SvgPlot plot(r.estimates.table.name[p], {"time, s"}, y, 485, 160);
  plot.add(SvgSeries{"", 5, SvgMark::thin_line, t, low});
  plot.add(SvgSeries{"", 5, SvgMark::thin_line, t, high});
  plot.add(SvgSeries{"", 0, SvgMark::line, t, v});
  if (reference > y.low && reference < y.high) plot.add_rule(reference);
  return plot.svg();
}

std::string quotient_plots(const TransferFunction& t) {
  const std::string direction = letter(t.direction);
  SvgAxis f{"frequency, Hz"};
  f.low = 0;
  if (std::isfinite(t.model_mode_hz)) f.high = std::min(6 * t.model_mode_hz, t.frequency_hz.back());
  SvgPlot gain("top floor over base, along " + direction, f,
               {"acceleration ratio", std::nan(""), std::nan(""), true}, 485, 240);
  gain.add(SvgSeries{"measured", 0, SvgMark::line, t.frequency_hz, t.measured});
  if (!t.model.empty())
    gain.add(SvgSeries{"reference-static model", 1, SvgMark::dashed, t.frequency_hz, t.model});
  SvgPlot coherence("coherence, along " + direction, f, {"coherence", 0, 1.05}, 485, 240);
  coherence.add(SvgSeries{"", 0, SvgMark::line, t.frequency_hz, t.coherence});
  return gain.svg() + coherence.svg();
}

constexpr std::size_t kMaxPerPlot = 24;  ///< parameters side by side

constexpr const char* kKindName[] = {"frame stiffness", "floor-panel stiffness", "frame damping",
                                     "floor-panel damping"};

std::vector<std::size_t> of_kind(const SessionReport& r, int kind) {
  std::vector<std::size_t> out;
  for (std::size_t p = 0; p < r.estimates.parameters(); ++p)
    if (r.estimates.table.kind[p] == kind) out.push_back(p);
  return out;
}

SvgAxis names(const SessionReport& r, const std::vector<std::size_t>& shown) {
  SvgAxis axis{""};
  for (const std::size_t p : shown) axis.categories.push_back(r.estimates.table.name[p]);
  return axis;
}

/// Returns the offset of member i of `count` that share a place on the axis.
double offset(std::size_t i, std::size_t count) {
  return 0.7 * ((static_cast<double>(i) + 0.5) / static_cast<double>(count) - 0.5);
}

/// Returns a plot's width: two plots fit side by side while there is room for their names.
int width(std::size_t shown) {
  return shown <= 3 ? 300 : shown <= 8 ? 485 : 980;
}

/// Plots the left part of Figure 10: means next to the references.
std::string means(const SessionReport& r, int kind, const std::vector<std::size_t>& shown) {
  const auto [per_unit, unit] = paper_unit(kind);
  const double factor = per_unit;
  std::vector<SvgSeries> groups;
  const auto reference = [&](const char* name, int color, const std::vector<double>& values) {
    SvgSeries group{name, color, SvgMark::bars, {}, {}};
    for (const std::size_t p : shown) group.y.push_back(factor * values[p]);
    if (std::any_of(group.y.begin(), group.y.end(), [](double v) { return std::isfinite(v); }))
      groups.push_back(std::move(group));
  };
  reference("reference-dynamic", 4, r.reference_dynamic);
  reference(r.reference_from_drawings ? "reference-static" : "start value", 6, r.reference_static);
  for (std::size_t s = 0; s < r.compared.size(); ++s) {
    groups.push_back({r.compared[s].name, static_cast<int>(s), SvgMark::bars, {}, {}});
    for (const std::size_t p : shown) {
      const ParameterSummary one = summarise(r.estimates, p, r.compared[s].boxes);
      groups.back().y.push_back(factor * one.mean);
      groups.back().error.push_back(factor * one.std_error);
    }
  }
  SvgPlot plot(std::string("means: ") + kKindName[kind], names(r, shown),
               {std::string(kKindName[kind]) + ", " + unit, 0}, width(shown.size()), 300);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (std::size_t i = 0; i < shown.size(); ++i)
      groups[g].x.push_back(static_cast<double>(i + 1) + offset(g, groups.size()));
    plot.add(groups[g]);
  }
  return plot.svg();
}

/// Plots the right part of Figure 10: boxplots of the windows.
std::string boxes(const SessionReport& r, int kind, const std::vector<std::size_t>& shown) {
  const auto [factor, unit] = paper_unit(kind);
  SvgPlot plot(fmt::format("windows: {}", kKindName[kind]), names(r, shown),
               {std::string(kKindName[kind]) + ", " + unit}, width(shown.size()), 300);
  for (std::size_t s = 0; s < r.compared.size(); ++s) {
    for (std::size_t i = 0; i < shown.size(); ++i) {
      ParameterSummary one = summarise(r.estimates, shown[i], r.compared[s].boxes);
      for (double* value : {&one.boxplot.q1, &one.boxplot.median, &one.boxplot.q3,
                            &one.boxplot.whisker_low, &one.boxplot.whisker_high})
        *value *= factor;
      for (double& value : one.outliers) value *= factor;
      plot.add(SvgBox{static_cast<double>(i + 1) + offset(s, r.compared.size()), one.boxplot,
                      one.outliers, static_cast<int>(s)});
    }
    plot.add(SvgSeries{r.compared[s].name,
                       static_cast<int>(s),
                       SvgMark::line,
                       {estimator::kNaN},
                       {estimator::kNaN}});
  }
  bool first = true;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const double at = factor * r.reference_static[shown[i]];
    if (!std::isfinite(at)) continue;
    const double x = static_cast<double>(i + 1);
    plot.add(SvgSeries{!first                      ? ""
                       : r.reference_from_drawings ? "reference-static"
                                                   : "start value",
                       6,
                       SvgMark::dashed,
                       {x - 0.45, x + 0.45},
                       {at, at}});
    first = false;
  }
  return plot.svg();
}

/// Plots peak accelerations or drifts over the building's height, with measured floors marked.
std::string over_height(const SessionFloors& floors, const estimator::Structure& s,
                        const char* title, const char* unit, bool drift) {
  SvgPlot plot(title, {unit, 0}, {"floor", 0, s.stories + 0.5}, 485, 480);
  for (const int along : framed_directions(s)) {
    SvgSeries line{along == 0 ? "along x" : "along y", along, SvgMark::line, {}, {}};
    SvgSeries dots{"", along, SvgMark::dots, {}, {}};
    for (int floor = drift ? 1 : 0; floor <= s.stories; ++floor) {
      const auto at = static_cast<std::size_t>(floor), d = static_cast<std::size_t>(along);
      const double value =
          drift ? 100 * peak_drift_ratio(floors, s, floor, along) : floors.peak_accel_mps2[at][d];
      line.x.push_back(value);
      line.y.push_back(drift ? floor - 0.5 : floor);
      if (drift || !floors.measured[at][d]) continue;
      dots.x.push_back(value);
      dots.y.push_back(floor);
    }
    plot.add(std::move(line));
    plot.add(std::move(dots));
  }
  return plot.svg();
}

std::string left_out_table(const SessionFloors& floors) {
  std::vector<std::vector<std::string>> rows;
  for (const estimator::LeftOutFloor& one : floors.left_out) {
    rows.push_back({fmt::format("floor {}, {}", one.floor, letter(one.direction))});
    for (const double error : {one.low_error, one.error, one.low_spline, one.spline})
      rows.back().push_back(or_dash(100 * error, "{:.1f}"));
  }
  return html_table({"left out", "error below 5 Hz, %", "error, %", "of a spline below 5 Hz, %",
                     "of a spline, %"},
                    rows);
}

std::string largest_error(const SessionFloors& floors) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const estimator::LeftOutFloor& one : floors.left_out) {
    if (!std::isfinite(one.low_error)) continue;
    least = std::min(least, one.low_error);
    most = std::max(most, one.low_error);
  }
  if (!(most > 0)) return "";
  return fmt::format(
      " Predicted from the others, measured floors are off by {:.0f} to {:.0f} % below 5 Hz: "
      "floors without a channel are not better.",
      100 * least, 100 * most);
}

/// Adds the loop and the identified stiffness of one stage to a plot.
void add_loop(const SessionReport& r, const FrameLoop& loop, std::size_t stage, int color,
              SvgPlot& plot) {
  std::vector<double> d, f;
  const auto stride =
      std::max<std::size_t>(1, loop.drift_m.size() / static_cast<std::size_t>(kMaxLoopPoints));
  for (std::size_t i = 0; i < loop.drift_m.size(); i += stride) {
    d.push_back(1e3 * loop.drift_m[i]);
    f.push_back(loop.force_n[i]);
  }
  plot.add(SvgSeries{"", color, SvgMark::thin_line, d, f});
  if (loop.parameter < 0) return;
  const auto p = static_cast<std::size_t>(loop.parameter);
  const double k = summarise(r.estimates, p, r.compared[stage].whole).boxplot.median;
  const double end = loop.largest_drift_m;
  if (std::isfinite(k))
    plot.add(SvgSeries{"", color, SvgMark::dashed, {-1e3 * end, 1e3 * end}, {-k * end, k * end}});
}

/// Returns a heading with the stage's name and a table of the largest drifts and forces.
std::string loop_table(const SessionReport& r, const StageLoops& of) {
  std::vector<std::vector<std::string>> rows;
  for (const FrameLoop& loop : of.loops.loops) {
    const double height =
        r.config->pipeline.structure.story_height[static_cast<std::size_t>(loop.story - 1)];
    double largest_force = 0;
    for (const double f : loop.force_n) largest_force = std::max(largest_force, std::abs(f));
    rows.push_back({html_text(loop.name), fmt::format("{:.3f}", 1e3 * loop.largest_drift_m),
                    fmt::format("{:.3f}", 100 * loop.largest_drift_m / height),
                    fmt::format("{:.2f}", largest_force)});
  }
  return "<h3>" + html_text(r.compared[of.stage].name) + "</h3>\n" +
         html_table({"frame", "largest drift, mm", "of the story height, %", "largest force, N"},
                    rows);
}

}  // namespace

std::string histories_section(const SessionReport& r) {
  std::string out = "<h2>Histories</h2>\n";
  if (r.motion && r.config)
    out += html_figure({motion_plot(r, true), motion_plot(r, false)},
                       "Measured acceleration, absolute.");
  out += stages_section(r);
  std::vector<double> t;
  for (const std::int64_t end : r.estimates.end_us) t.push_back(session_seconds(r, end));
  for (const bool stiffness : {true, false}) {
    std::vector<std::string> plots;
    std::size_t left_out = 0;
    for (std::size_t p = 0; p < r.estimates.parameters(); ++p) {
      const int kind = r.estimates.table.kind[p];
      if (is_stiffness_kind(kind) != stiffness) continue;
      if (plots.size() < kMaxHistories)
        plots.push_back(history(r, p, t));
      else
        ++left_out;
    }
    if (plots.empty()) continue;
    out += html_figure(
        plots, fmt::format(
                   "{}, at the end of each window; pale: one standard error to either side; "
                   "dotted: {}. The line breaks where nothing is published. The axes leave out one "
                   "in a hundred windows at either end.{}",
                   stiffness ? "Stiffness" : "Damping",
                   r.reference_from_drawings ? "reference-static" : "start value",
                   left_out > 0 ? fmt::format(" {} more parameters are in the log.", left_out)
                                : std::string()));
  }
  SvgPlot residual("", {"time, s"}, {"residual / response"}, 980, 150);
  residual.add(SvgSeries{"", 6, SvgMark::thin_line, t, r.estimates.residual_ratio});
  return out + html_figure({residual.svg()},
                           "Part of the response that the model does not explain, rms over rms.");
}

std::string transfer_section(const SessionReport& r) {
  const bool changed = !r.transfer_after.empty();
  std::vector<std::string> plots;
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const std::vector<TransferFunction>& transfer, const char* when) {
    for (const TransferFunction& t : transfer) {
      plots.push_back(quotient_plots(t));
      rows.push_back({std::string(letter(t.direction)) + when,
                      or_dash(t.measured_mode_hz, "{:.3f}"), or_dash(t.model_mode_hz, "{:.3f}"),
                      or_dash(t.mac, "{:.2f}"), or_dash(t.stiffness_ratio(), "{:.3f}"),
                      fmt::format("{}", t.segments)});
    }
  };
  add(r.transfer, changed ? ", before the change" : "");
  add(r.transfer_after, ", after the change");
  if (rows.empty()) return "";
  return "<h2>Transfer functions</h2>\n" +
         html_figure(
             plots,
             "Mean of the top floor's frames over the base, from the longest forced stage. "
             "The model has the reference-static values and moves with the measured base.") +
         html_table({"direction", "measured mode, Hz", "model's mode, Hz", "likeness (MAC)",
                     "reference-dynamic / reference-static", "segments"},
                    rows) +
         "<p>The model's lowest mode along the direction is paired with the measured peak of the "
         "most similar shape. A MAC of 1 means equal shapes; modes with a MAC below 0.8 are not "
         "paired. Reference-dynamic stiffness is reference-static stiffness times the square of "
         "the ratio of the two frequencies, for the frames of that direction.</p>\n";
}

std::string loops_section(const SessionReport& r) {
  if (r.loops.empty()) return "";
  std::string out = "<h2>Drift and restoring force</h2>\n", tables, spans;
  std::vector<const StageLoops*> shown;
  for (const StageLoops& of : r.loops) {
    if (!of.loops.reason.empty()) {
      out += "<p>Not shown for " + html_text(r.compared[of.stage].name) + ": " +
             html_text(of.loops.reason) + ".</p>\n";
      continue;
    }
    spans += fmt::format("{}{}, {:.1f} s to {:.1f} s", shown.empty() ? "" : "; ",
                         shown.empty() ? html_text(r.compared[of.stage].name)
                                       : "orange: " + html_text(r.compared[of.stage].name),
                         session_seconds(r, of.loops.from_us), session_seconds(r, of.loops.to_us));
    shown.push_back(&of);
    tables += loop_table(r, of);
  }
  if (shown.empty()) return out;
  std::vector<std::string> plots;
  const std::vector<FrameLoop>& frames = shown.front()->loops.loops;
  for (std::size_t i = 0; i < std::min(frames.size(), kMaxLoops); ++i) {
    SvgPlot plot(frames[i].name, {"story drift, mm"}, {"force, N"}, 242, 210);
    int color = 0;
    for (const StageLoops* of : shown) add_loop(r, of->loops.loops[i], of->stage, color++, plot);
    plots.push_back(plot.svg());
  }
  return out +
         html_figure(
             plots,
             fmt::format("The strongest motion ({}): restoring force with damping over story "
                         "drift, above {:g} Hz; dashed: the identified stiffness (median).{}",
                         spans, r.config->pipeline.options.high_pass_hz,
                         frames.size() > kMaxLoops ? " Only the first frames are shown." : "")) +
         tables;
}

std::string figure_10_section(const SessionReport& r) {
  std::string out = "<h2>Identified stiffness and damping</h2>\n";
  for (int kind = 0; kind < 4; ++kind) {
    const std::vector<std::size_t> all = of_kind(r, kind);
    for (std::size_t from = 0; from < all.size(); from += kMaxPerPlot) {
      const std::vector<std::size_t> shown(
          all.begin() + static_cast<std::ptrdiff_t>(from),
          all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), from + kMaxPerPlot)));
      std::string caption = fmt::format(
          "{}: on the left the means, with whiskers of one standard error of a window; on the "
          "right a boxplot per parameter (median, quartiles, adjacent values, outliers as +), of ",
          kKindName[kind]);
      for (std::size_t s = 0; s < r.compared.size(); ++s)
        caption += fmt::format(
            "{}{} windows of {:g} s in {}", s == 0 ? "" : " and ", r.compared[s].boxes.size(),
            r.estimates.table.window_rows / r.estimates.table.rate_hz, r.compared[s].name);
      out += html_figure({means(r, kind, shown), boxes(r, kind, shown)}, caption + ".");
    }
  }
  return out;
}

std::string floors_section(const SessionReport& r) {
  if (!r.floors) return "";
  const SessionFloors& floors = *r.floors;
  const estimator::Structure& s = r.config->pipeline.structure;
  std::string out =
      "<h2>Every floor</h2>\n" +
      html_figure({over_height(floors, s, "peak acceleration", "m/s^2", false),
                   over_height(floors, s, "peak story drift", "% of the story height", true)},
                  fmt::format("Dots: floors with a channel. The others are computed from the "
                              "measured floors above and below with the identified stiffnesses.{}",
                              largest_error(floors)));
  std::vector<std::vector<std::string>> rows;
  for (int floor = s.stories; floor >= 0; --floor) {
    std::vector<std::string> row{floor > 0 ? fmt::format("floor {}", floor) : "base"};
    for (const int along : framed_directions(s)) {
      const auto at = static_cast<std::size_t>(floor), d = static_cast<std::size_t>(along);
      row.push_back(floors.measured[at][d] ? "measured" : "computed");
      row.push_back(or_dash(floors.peak_accel_mps2[at][d], "{:.3f}"));
      row.push_back(floor > 0 ? or_dash(100 * peak_drift_ratio(floors, s, floor, along), "{:.4f}")
                              : "-");
    }
    rows.push_back(std::move(row));
  }
  std::vector<std::string> head{""};
  for (const int along : framed_directions(s))
    for (const char* what : {"", " acceleration, m/s^2", " drift of the story below, %"})
      head.push_back((along == 0 ? "x" : "y") + std::string(what));
  out += html_table(head, rows);
  if (floors.left_out.empty()) return out;
  return out + "<h3>Measured floors left out in turn</h3>\n" + left_out_table(floors) +
         fmt::format(
             "<p>Each floor is predicted from all others with the stiffnesses identified in the "
             "strong motion ({:.1f} s to {:.1f} s, 5 to 95 % of the Arias intensity at the top). "
             "Errors are rms of the error over rms of the motion. The spline goes through the "
             "other floors; next to a channel one story away it may do as well.</p>\n",
             session_seconds(r, floors.from_us), session_seconds(r, floors.to_us));
}

}  // namespace framewatch::daemon
