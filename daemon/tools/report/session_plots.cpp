// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/svg_plot.h"
#include "daemon/base/words.h"
#include "daemon/monitor/estimates/parameter_summary.h"
#include "daemon/tools/report/mode_pictures.h"
#include "daemon/tools/report/session_report.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxHistories = 48, kMaxLoops = 32;
constexpr Eigen::Index kMaxLoopPoints = 1000;

Picture motion_picture(const SessionReport& r, bool base) {
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
  return {base ? "acceleration-base" : "acceleration-top", std::move(plot)};
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
Picture history(const SessionReport& r, std::size_t p, const std::vector<double>& t) {
  const int kind = r.estimates.table.kind[p];
  const auto [factor, unit] = r.units.of(kind);
  const auto& value = r.estimates.value[p];
  std::vector<double> v, low, high;
  for (std::size_t w = 0; w < value.size(); ++w) {
    v.push_back(factor * value[w]);
    low.push_back(factor * (value[w] - r.estimates.std_error[p][w]));
    high.push_back(factor * (value[w] + r.estimates.std_error[p][w]));
  }
  const double reference = factor * r.reference_static[p];
  const char* quantity = is_stiffness_kind(kind) ? "stiffness, " : "damping, ";
  const SvgAxis y = without_spikes({quantity + unit}, v, reference);
  SvgPlot plot(place_of(r, p), {"time, s"}, y, 485, 160);
  plot.add(SvgSeries{"", 5, SvgMark::thin_line, t, low, {}, "less one standard error"});
  plot.add(SvgSeries{"", 5, SvgMark::thin_line, t, high, {}, "plus one standard error"});
  plot.add(SvgSeries{"", 0, SvgMark::line, t, v, {}, "estimate"});
  if (reference > y.low && reference < y.high) plot.add_rule(reference);
  return {"history-" + r.estimates.table.name[p], std::move(plot)};
}

/// Adds the pictures of one direction. when: "" or "-after".
void add_quotients(const TransferFunction& t, const std::string& when, std::vector<Picture>& to) {
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
  coherence.add(SvgSeries{"", 0, SvgMark::line, t.frequency_hz, t.coherence, {}, "measured"});
  to.push_back({"transfer-" + direction + when, std::move(gain)});
  to.push_back({"coherence-" + direction + when, std::move(coherence)});
}

/// Plots peak accelerations or drifts over the building's height, with measured floors marked.
Picture over_height(const SessionFloors& floors, const estimator::Structure& s, bool drift) {
  SvgPlot plot(drift ? "peak story drift" : "peak acceleration",
               {drift ? "peak story drift, % of the height" : "peak acceleration, m/s^2", 0},
               {"floor", 0, s.stories + 0.5}, 485, 480);
  for (const int along : framed_directions(s)) {
    SvgSeries line{along == 0 ? "along x" : "along y", along, SvgMark::line, {}, {}};
    SvgSeries dots{"", along, SvgMark::dots, {}, {}, {}, "measured along "};
    dots.told += along == 0 ? "x" : "y";
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
  return {drift ? "floors-drift" : "floors-acceleration", std::move(plot)};
}

std::vector<Picture> floor_pictures(const SessionReport& r) {
  if (!r.floors) return {};
  const estimator::Structure& s = r.config->pipeline.structure;
  return {over_height(*r.floors, s, false), over_height(*r.floors, s, true)};
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
  const double per_n = r.units.of_force().first;
  const auto stride =
      std::max<std::size_t>(1, loop.drift_m.size() / static_cast<std::size_t>(kMaxLoopPoints));
  for (std::size_t i = 0; i < loop.drift_m.size(); i += stride) {
    d.push_back(1e3 * loop.drift_m[i]);
    f.push_back(per_n * loop.force_n[i]);
  }
  const std::string& name = r.compared[stage].name;
  plot.add(SvgSeries{"", color, SvgMark::thin_line, d, f, {}, name});
  if (loop.parameter < 0) return;
  const auto p = static_cast<std::size_t>(loop.parameter);
  const double k = summarise(r.estimates, p, r.compared[stage].whole).boxplot.median;
  const double end = loop.largest_drift_m, force = per_n * k * end;
  if (std::isfinite(k))
    plot.add(SvgSeries{"",
                       color,
                       SvgMark::dashed,
                       {-1e3 * end, 1e3 * end},
                       {-force, force},
                       {},
                       name + ": identified stiffness"});
}

/// Returns the words for a loop's place: "story 1, north wall", or "story 1, x" for all frames.
std::string loop_name(const SessionReport& r, const FrameLoop& loop) {
  return loop.parameter < 0 ? loop.name : place_of(r, static_cast<std::size_t>(loop.parameter));
}

/// Returns the stages whose loops are shown.
std::vector<const StageLoops*> shown_loops(const SessionReport& r) {
  std::vector<const StageLoops*> out;
  for (const StageLoops& of : r.loops)
    if (of.loops.reason.empty()) out.push_back(&of);
  return out;
}

std::vector<Picture> loop_pictures(const SessionReport& r) {
  const std::vector<const StageLoops*> shown = shown_loops(r);
  if (shown.empty()) return {};
  std::vector<Picture> out;
  const std::vector<FrameLoop>& frames = shown.front()->loops.loops;
  for (std::size_t i = 0; i < std::min(frames.size(), kMaxLoops); ++i) {
    SvgPlot plot(loop_name(r, frames[i]), {"story drift, mm"},
                 {"force, " + r.units.of_force().second}, 242, 210);
    int color = 0;
    for (const StageLoops* of : shown) add_loop(r, of->loops.loops[i], of->stage, color++, plot);
    out.push_back({"loop-" + frames[i].name, std::move(plot)});
  }
  return out;
}

/// Returns the parameters of one sort that have a history, and how many are left out.
std::pair<std::vector<std::size_t>, std::size_t> with_history(const SessionReport& r,
                                                              bool stiffness) {
  std::vector<std::size_t> out;
  for (std::size_t p = 0; p < r.estimates.parameters(); ++p)
    if (is_stiffness_kind(r.estimates.table.kind[p]) == stiffness) out.push_back(p);
  const std::size_t all = out.size();
  out.resize(std::min(all, kMaxHistories));
  return {out, all - out.size()};
}

std::vector<Picture> motion_pictures(const SessionReport& r) {
  if (!r.motion || !r.config) return {};
  return {motion_picture(r, true), motion_picture(r, false)};
}

/// Returns the ends of the windows, seconds of the session.
std::vector<double> window_seconds(const SessionReport& r) {
  std::vector<double> out;
  for (const std::int64_t end : r.estimates.end_us) out.push_back(session_seconds(r, end));
  return out;
}

std::vector<Picture> history_pictures(const SessionReport& r, bool stiffness) {
  const std::vector<double> t = window_seconds(r);
  std::vector<Picture> out;
  for (const std::size_t p : with_history(r, stiffness).first) out.push_back(history(r, p, t));
  return out;
}

Picture residual_picture(const SessionReport& r) {
  SvgPlot plot("", {"time, s"}, {"residual / response"}, 980, 150);
  plot.add(SvgSeries{
      "", 6, SvgMark::thin_line, window_seconds(r), r.estimates.residual_ratio, {}, "residual"});
  return {"residual", std::move(plot)};
}

std::vector<Picture> transfer_pictures(const SessionReport& r) {
  std::vector<Picture> out;
  for (const TransferFunction& t : r.transfer) add_quotients(t, "", out);
  for (const TransferFunction& t : r.transfer_after) add_quotients(t, "-after", out);
  return out;
}

/// Returns a heading with the stage's name and a table of the largest drifts and forces.
std::string loop_table(const SessionReport& r, const StageLoops& of) {
  std::vector<std::vector<std::string>> rows;
  const auto [per_n, force_unit] = r.units.of_force();
  for (const FrameLoop& loop : of.loops.loops) {
    const double height =
        r.config->pipeline.structure.story_height[static_cast<std::size_t>(loop.story - 1)];
    double largest_force = 0;
    for (const double f : loop.force_n) largest_force = std::max(largest_force, std::abs(f));
    rows.push_back({html_text(loop_name(r, loop)),
                    fmt::format("{:.3f}", 1e3 * loop.largest_drift_m),
                    fmt::format("{:.3f}", 100 * loop.largest_drift_m / height),
                    fmt::format("{:.4g}", per_n * largest_force)});
  }
  return "<h3>" + html_text(r.compared[of.stage].name) + "</h3>\n" +
         html_table({"frame", "largest drift, mm", "of the story height, %",
                     "largest force, " + force_unit},
                    rows);
}

}  // namespace

std::string histories_section(const SessionReport& r) {
  std::string out = "<h2>Histories</h2>\n";
  if (r.motion && r.config)
    out += html_figure(motion_pictures(r), "Measured acceleration, absolute.");
  out += stages_section(r);
  for (const bool stiffness : {true, false}) {
    const std::vector<Picture> plots = history_pictures(r, stiffness);
    const std::size_t left_out = with_history(r, stiffness).second;
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
  return out + html_figure(std::vector<Picture>{residual_picture(r)},
                           "Part of the response that the model does not explain, rms over rms.");
}

std::string transfer_section(const SessionReport& r) {
  const bool changed = !r.transfer_after.empty();
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const std::vector<TransferFunction>& transfer, const char* when) {
    for (const TransferFunction& t : transfer) {
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
             transfer_pictures(r),
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
  const std::vector<const StageLoops*> shown = shown_loops(r);
  for (const StageLoops& of : r.loops) {
    if (!of.loops.reason.empty()) {
      out += "<p>Not shown for " + html_text(r.compared[of.stage].name) + ": " +
             html_text(of.loops.reason) + ".</p>\n";
      continue;
    }
    spans += fmt::format("{}{}, {:.1f} s to {:.1f} s", spans.empty() ? "" : "; ",
                         spans.empty() ? html_text(r.compared[of.stage].name)
                                       : "orange: " + html_text(r.compared[of.stage].name),
                         session_seconds(r, of.loops.from_us), session_seconds(r, of.loops.to_us));
    tables += loop_table(r, of);
  }
  if (shown.empty()) return out;
  const std::size_t frames = shown.front()->loops.loops.size();
  return out +
         html_figure(
             loop_pictures(r),
             fmt::format("The strongest motion ({}): restoring force with damping over story "
                         "drift, above {:g} Hz; dashed: the identified stiffness (median).{}",
                         spans, r.config->pipeline.options.high_pass_hz,
                         frames > kMaxLoops ? " Only the first frames are shown." : "")) +
         tables;
}

std::vector<Picture> session_pictures(const SessionReport& r) {
  std::vector<Picture> out = change_pictures(r);
  const auto add = [&](std::vector<Picture> more) {
    std::move(more.begin(), more.end(), std::back_inserter(out));
  };
  add(parameter_pictures(r));
  add(floor_pictures(r));
  add(loop_pictures(r));
  add(transfer_pictures(r));
  for (const StageModes& of : r.modes)
    add(mode_pictures(of.modes, r.compared[of.stage].after ? "-after" : ""));
  add(motion_pictures(r));
  add(history_pictures(r, true));
  add(history_pictures(r, false));
  add({residual_picture(r)});
  return out;
}

std::string floors_section(const SessionReport& r) {
  if (!r.floors) return "";
  const SessionFloors& floors = *r.floors;
  const estimator::Structure& s = r.config->pipeline.structure;
  std::string out =
      "<h2>Every floor</h2>\n" +
      html_figure(floor_pictures(r),
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
