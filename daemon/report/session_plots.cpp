#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/documents/html_page.h"
#include "daemon/documents/svg_plot.h"
#include "daemon/report/session_report.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMostHistories = 48, kMostLoops = 32;
constexpr Eigen::Index kMostLoopPoints = 1000;

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
    if (m.axes[a].story != story) continue;
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
  const std::string direction = t.direction == estimator::Direction::x ? "x" : "y";
  SvgAxis f{"frequency, Hz"};
  f.low = 0;
  if (std::isfinite(t.model_peak_hz)) f.high = std::min(6 * t.model_peak_hz, t.frequency_hz.back());
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
      if ((kind < 2) != stiffness) continue;
      if (plots.size() < kMostHistories)
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
  if (r.transfer.empty()) return "";
  std::vector<std::string> plots;
  std::vector<std::vector<std::string>> rows;
  for (const TransferFunction& t : r.transfer) {
    plots.push_back(quotient_plots(t));
    const auto hz = [](double f) { return std::isfinite(f) ? fmt::format("{:.3f}", f) : "-"; };
    rows.push_back({t.direction == estimator::Direction::x ? "x" : "y", hz(t.measured_peak_hz),
                    hz(t.model_peak_hz), hz(t.stiffness_ratio()), fmt::format("{}", t.segments)});
  }
  return "<h2>Transfer functions</h2>\n" +
         html_figure(
             plots,
             "Mean of the top floor's frames over the base, from the longest forced stage. "
             "The model has the reference-static values and moves with the measured base.") +
         html_table({"direction", "measured peak, Hz", "model's peak, Hz",
                     "reference-dynamic / reference-static", "segments"},
                    rows) +
         "<p>Reference-dynamic stiffness is reference-static stiffness times the square of the "
         "ratio "
         "of the two fundamental peaks, for the frames of that direction.</p>\n";
}

std::string loops_section(const SessionReport& r) {
  if (!r.loops) return "";
  std::string out = "<h2>Drift and restoring force</h2>\n";
  if (!r.loops->reason.empty())
    return out + "<p>Not shown: " + html_text(r.loops->reason) + ".</p>\n";
  std::vector<std::string> plots;
  std::vector<std::vector<std::string>> rows;
  for (const FrameLoop& loop : r.loops->loops) {
    const double height =
        r.config->pipeline.structure.story_height[static_cast<std::size_t>(loop.story - 1)];
    double largest_force = 0;
    for (const double f : loop.force_n) largest_force = std::max(largest_force, std::abs(f));
    rows.push_back({html_text(loop.name), fmt::format("{:.3f}", 1e3 * loop.largest_drift_m),
                    fmt::format("{:.3f}", 100 * loop.largest_drift_m / height),
                    fmt::format("{:.2f}", largest_force)});
    if (plots.size() == kMostLoops) continue;
    std::vector<double> d, f;
    const auto stride =
        std::max<std::size_t>(1, loop.drift_m.size() / static_cast<std::size_t>(kMostLoopPoints));
    for (std::size_t i = 0; i < loop.drift_m.size(); i += stride) {
      d.push_back(1e3 * loop.drift_m[i]);
      f.push_back(loop.force_n[i]);
    }
    SvgPlot plot(loop.name, {"story drift, mm"}, {"force, N"}, 242, 210);
    plot.add(SvgSeries{"", 0, SvgMark::thin_line, d, f});
    if (loop.parameter >= 0) {
      const auto p = static_cast<std::size_t>(loop.parameter);
      const double k = summarise(r.estimates, p, r.compared.front().whole).boxplot.median;
      const double end = loop.largest_drift_m;
      if (std::isfinite(k))
        plot.add(SvgSeries{"", 1, SvgMark::dashed, {-1e3 * end, 1e3 * end}, {-k * end, k * end}});
    }
    plots.push_back(plot.svg());
  }
  out += html_figure(
      plots, fmt::format("{:.1f} s to {:.1f} s, the strongest motion: restoring force with damping "
                         "over story drift, above {:g} Hz; dashed: the identified stiffness "
                         "(median).{}",
                         session_seconds(r, r.loops->from_us), session_seconds(r, r.loops->to_us),
                         r.config->pipeline.options.high_pass_hz,
                         r.loops->loops.size() > kMostLoops ? " The first frames only." : ""));
  return out +
         html_table({"frame", "largest drift, mm", "of the story height, %", "largest force, N"},
                    rows);
}

}  // namespace framewatch::daemon
