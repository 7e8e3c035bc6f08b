#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/svg_plot.h"
#include "daemon/monitor/estimates/parameter_summary.h"
#include "daemon/tools/report/session_report.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxHistories = 48, kMaxLoops = 32;
constexpr Eigen::Index kMaxLoopPoints = 1000;

std::vector<double> window_times(const SessionReport& r) {
  std::vector<double> out;
  for (const std::int64_t end : r.estimates.end_us) out.push_back(session_seconds(r, end));
  return out;
}

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

/// An axis that ends around 98 % of the values and the reference, if that is near: a few windows at
/// the end of a free vibration must not flatten all the others.
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

/// Value and one standard error to either side, over time.
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

}  // namespace

std::string histories_section(const SessionReport& r) {
  std::string out = "<h2>Histories</h2>\n";
  if (r.motion && r.config)
    out += html_figure({motion_plot(r, true), motion_plot(r, false)},
                       "Measured acceleration, absolute.");
  out += stages_section(r);
  const std::vector<double> t = window_times(r);
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
        plots,
        fmt::format("{}, at the end of each window; pale: one standard error to either side; "
                    "dotted: {}. A break: nothing is published. The axes leave out one in a "
                    "hundred windows at "
                    "either end.{}",
                    stiffness ? "Stiffness" : "Damping",
                    r.reference_from_drawings ? "reference-static" : "start value",
                    left_out > 0 ? fmt::format(" {} more parameters are in the log.", left_out)
                                 : std::string()));
  }
  SvgPlot residual("", {"time, s"}, {"residual / response"}, 980, 150);
  residual.add(SvgSeries{"", 6, SvgMark::thin_line, t, r.estimates.residual_ratio});
  return out +
         html_figure({residual.svg()}, "What the model leaves of the response, rms over rms.");
}

std::string transfer_section(const SessionReport& r) {
  const bool changed = !r.transfer_after.empty();
  std::vector<std::string> plots;
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const std::vector<TransferFunction>& transfer, const char* when) {
    for (const TransferFunction& t : transfer) {
      plots.push_back(quotient_plots(t));
      const auto number = [](double f, int digits) {
        return std::isfinite(f) ? fmt::format("{:.{}f}", f, digits) : "-";
      };
      rows.push_back({std::string(letter(t.direction)) + when, number(t.measured_mode_hz, 3),
                      number(t.model_mode_hz, 3), number(t.mac, 2), number(t.stiffness_ratio(), 3),
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
         "<p>The model's lowest mode along the direction, and the measured peak whose shape is "
         "most "
         "like its: MAC 1 is the same shape, below 0.8 nothing is paired. Reference-dynamic "
         "stiffness is reference-static stiffness times the square of the ratio of the two "
         "frequencies, for the frames of that direction.</p>\n";
}

namespace {

/// The loop and the identified stiffness of one stage.
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

/// What the loops of one stage came to, and the stage's name in the color of its loops.
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

std::string loops_section(const SessionReport& r) {
  if (r.loops.empty()) return "";
  std::string out = "<h2>Drift and restoring force</h2>\n", tables, spans;
  std::vector<const StageLoops*> shown;
  for (const StageLoops& of : r.loops) {
    if (!of.loops.reason.empty()) {
      out += "<p>Not shown of " + html_text(r.compared[of.stage].name) + ": " +
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
         html_figure(plots,
                     fmt::format("The strongest motion ({}): restoring force with damping "
                                 "over story drift, above {:g} Hz; dashed: the identified "
                                 "stiffness (median).{}",
                                 spans, r.config->pipeline.options.high_pass_hz,
                                 frames.size() > kMaxLoops ? " The first frames only." : "")) +
         tables;
}

}  // namespace framewatch::daemon
