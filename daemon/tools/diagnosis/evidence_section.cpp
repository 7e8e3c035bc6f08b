// SPDX-License-Identifier: MIT
#include "daemon/tools/diagnosis/evidence_section.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/svg_plot.h"
#include "daemon/base/words.h"

namespace framewatch::daemon {
namespace {

using estimator::PlaceForce;

constexpr double kMillimetres = 1e3;
constexpr double kKilonewton = 1e3;      // N; smaller forces are in N
constexpr double kNoLouder = 1.1;        // rms of the rest over that of noise
constexpr double kOutsideShare = 0.05;   // of the lags, by chance
constexpr double kVisibleShare = 0.005;  // of the force
constexpr Eigen::Index kDots = 200;      // of the measured force
constexpr int kNarrow = 480,
              kTall = 300;  // px; two plots fit beside each other, and a phone shows one

// Colors and marks of every plot here: what is measured, the linear model, the model with the
// effects, noise.
constexpr int kMeasured = 6, kLinear = 1, kWithEffects = 0, kNoise = 2;

std::vector<double> scaled(const Eigen::VectorXd& v, double factor) {
  std::vector<double> out;
  for (const double value : v) out.push_back(factor * value);
  return out;
}

std::string with_name(const DiagnoseOutput& o) {
  return o.diagnosis.effects.size() > 1 ? "with the effects" : "with the effect";
}

bool has_effects(const DiagnoseOutput& o) {
  return !o.diagnosis.effects.empty();
}

double largest(const PlaceForce& f) {
  return std::max({f.measured_n, f.linear_n, f.with_effects_n});
}

std::string force_words(double newtons) {
  return newtons < kKilonewton ? fmt::format("{:.3g} N", newtons)
                               : fmt::format("{:.3g} kN", newtons / kKilonewton);
}

std::string place_words(const DiagnoseOutput& o, const PlaceForce& f) {
  return place_text(f.place, o.plant.structure, o.plant.axes);
}

std::string percent(double share) {
  return fmt::format("{:.2g} %", 100 * share);
}

/// Returns at most kDots of a curve's points.
estimator::ForceCurve thinned(const estimator::ForceCurve& curve) {
  const Eigen::Index stride = (curve.d_m.size() + kDots - 1) / kDots;
  if (stride < 2) return curve;
  const Eigen::Index count = (curve.d_m.size() + stride - 1) / stride;
  const auto every = Eigen::seqN(Eigen::Index{0}, count, stride);
  return {curve.d_m(every), curve.force_n(every)};
}

std::string force_plot(const DiagnoseOutput& o, const PlaceForce& f) {
  const bool kilo = largest(f) >= kKilonewton;
  const double to_unit = kilo ? 1 / kKilonewton : 1;
  SvgPlot plot(place_words(o, f), {"deformation, mm"},
               {kilo ? "restoring force, kN" : "restoring force, N"}, kNarrow, kTall + 60);
  const auto add = [&](const char* name, int color, SvgMark mark,
                       const estimator::ForceCurve& curve) {
    if (curve.d_m.size() > 0)
      plot.add(
          {name, color, mark, scaled(curve.d_m, kMillimetres), scaled(curve.force_n, to_unit)});
  };
  if (f.is_element) add("linear model", kLinear, SvgMark::dashed, f.linear);
  const std::string with = with_name(o);
  add(with.c_str(), kWithEffects, SvgMark::line, f.with_effects);
  add("measured", kMeasured, SvgMark::dots, thinned(f.measurement));  // on top of the lines
  plot.describe(force_sentence(o, f));
  return plot.svg();
}

}  // namespace

std::string force_source(const DiagnoseOutput& o, const PlaceForce& f) {
  if (!f.measured)
    return "No sensors read this deformation, or the motion of all floors that load it: only the "
           "models are shown.";
  std::string out = "Measured: ", from = ", from their motion and masses";
  for (Eigen::Index a = 0; a < o.plant.axis_count(); ++a)
    if (o.plant.is_force(a)) from = ", from their motion and masses, and the force on them";
  if (f.place.kind != estimator::PlaceKind::frame || !f.is_element)
    out += "the inertia of the floors there" + from +
           ", less what the model says of the other elements";
  else if (f.of_direction)
    out += "the inertia of the floors above" + from +
           ". Rigid floors share it among the frames of this direction, so the other frames' "
           "forces by the model are subtracted";
  else
    out += "the inertia of this frame's floors above" + from;
  if (f.modelled_share > kVisibleShare)
    out += f.place.kind == estimator::PlaceKind::frame && f.is_element && !f.of_direction
               ? fmt::format(
                     ", less what the floor panels give to other frames by the model ({} "
                     "of this force, rms)",
                     percent(f.modelled_share))
               : fmt::format(" ({} of this force, rms)", percent(f.modelled_share));
  return out +
         fmt::format(". Forces and deformations hold {:.3g} to {:.3g} Hz.", f.low_hz, f.high_hz);
}

std::string force_sentence(const DiagnoseOutput& o, const PlaceForce& f) {
  std::string out = fmt::format("{} deforms by up to {:.3g} mm", with_capital(place_words(o, f)),
                                kMillimetres * f.peak_d_m);
  if (f.place.kind == estimator::PlaceKind::frame && f.is_element) {
    const double height =
        o.plant.structure.story_height[static_cast<std::size_t>(f.place.story - 1)];
    out += fmt::format(" ({:.2g} % of the story's height)", 100 * f.peak_d_m / height);
  }
  std::vector<std::string> forces;
  if (f.measured) forces.push_back(force_words(f.measured_n) + " measured");
  if (f.is_element && f.linear.d_m.size() > 0)
    forces.push_back(force_words(f.linear_n) + " by the linear model");
  if (f.with_effects.d_m.size() > 0)
    forces.push_back(force_words(f.with_effects_n) + " " + with_name(o));
  if (!forces.empty()) out += fmt::format(". Its largest force is {}", listed(forces));
  if (f.measured) {
    std::vector<std::string> off;
    if (f.is_element && f.linear.d_m.size() > 0)
      off.push_back(percent(f.linear_off) + " without the effect");
    if (f.with_effects.d_m.size() > 0)
      off.push_back(percent(f.with_effects_off) + " " + with_name(o));
    if (!has_effects(o) && !off.empty()) off = {percent(f.linear_off)};
    if (!off.empty())
      out += fmt::format(
          ". Simulated and measured force differ by {}; the sensors' noise is {} of it (rms)",
          listed(off), percent(f.noise_n / std::max(f.measured_rms_n, 1e-300)));
  }
  return out + ".";
}

std::string force_section(const DiagnoseOutput& o) {
  const std::vector<PlaceForce>& forces = o.diagnosis.evidence.forces;
  if (forces.empty()) return "";
  std::string out = "<h2>Force and deformation</h2>\n";
  for (const PlaceForce& f : forces)
    out += html_paragraph(force_sentence(o, f)) +
           html_figure({force_plot(o, f)},
                       html_text(fmt::format(
                           "The strongest motion of {}, {:.1f} to {:.1f} s. {} The models are "
                           "driven by the {} alone.",
                           o.records[f.record].path, f.from_s, f.to_s, force_source(o, f),
                           driver_words(o))));
  return out;
}

std::string gap_parts_section(const DiagnoseOutput& o) {
  const estimator::Evidence& e = o.diagnosis.evidence;
  if (e.spectrum.hz.size() == 0) return "";
  std::vector<std::string> plots;
  SvgAxis over{fmt::format("rms of the channels, {}/sqrt(Hz)", gap_unit(o))};
  over.logarithmic = true;
  SvgPlot by_frequency("by frequency", {"frequency, Hz"}, over, kNarrow, kTall);
  const std::vector<double> hz = scaled(e.spectrum.hz, 1);
  by_frequency.add({"measured", kMeasured, SvgMark::line, hz, scaled(e.spectrum.measured, 1)});
  by_frequency.add({"gap before", kLinear, SvgMark::dashed, hz, scaled(e.spectrum.before, 1)});
  if (has_effects(o) && e.spectrum.after.size() > 0)
    by_frequency.add({"gap after", kWithEffects, SvgMark::line, hz, scaled(e.spectrum.after, 1)});
  by_frequency.add({"noise", kNoise, SvgMark::thin_line, hz, scaled(e.spectrum.noise, 1)});
  Eigen::Index worst = 0;
  e.spectrum.before.maxCoeff(&worst);
  by_frequency.describe(
      fmt::format("The gap before is largest at {:.3g} Hz.", e.spectrum.hz[worst]));
  plots.push_back(by_frequency.svg());

  SvgAxis floors{""};
  SvgSeries before{"before", kLinear, SvgMark::rings, {}, {}},
      after{"after", kWithEffects, SvgMark::dots, {}, {}},
      noise{"noise", kMeasured, SvgMark::bars, {}, {}};
  std::string told;
  for (const estimator::FloorGap& g : e.floors) {
    floors.categories.push_back(fmt::format("floor {}", g.story));
    const auto x = static_cast<double>(floors.categories.size());
    for (SvgSeries* s : {&before, &after, &noise}) s->x.push_back(x);
    before.y.push_back(100 * g.before);
    after.y.push_back(100 * g.after);
    noise.y.push_back(100 * g.floor);
    told += fmt::format("Floor {}: {} before{}. ", g.story, gap_percent(g.before),
                        has_effects(o) ? ", " + or_dash(100 * g.after, "{:.2f} % after") : "");
  }
  if (e.floors.size() < 2) floors.categories.clear();  // the table has it
  SvgPlot by_floor("by floor", floors, {"gap, % of the floor's motion"}, kNarrow, kTall);
  by_floor.add(noise);
  by_floor.add(before);
  if (has_effects(o)) by_floor.add(after);
  by_floor.describe(told);
  if (!floors.categories.empty()) plots.push_back(by_floor.svg());
  return html_figure(
      plots, "The gap of the " +
                 std::string(o.holdout_from < o.records.size() ? "held-out records" : "records") +
                 " and the gap that the sensors' noise alone would make.");
}

std::string residual_sentence(const DiagnoseOutput& o) {
  const estimator::ResidualCorrelation& c = o.diagnosis.evidence.correlation;
  const Eigen::Index lags = c.lag_s.size();
  if (lags == 0) return "";
  const bool with = has_effects(o) && c.after.size() > 0;
  const int outside = with ? c.after_outside : c.before_outside;
  const double level = with ? c.after_level : c.before_level;
  const std::string counts =
      with ? fmt::format("{} of {} lags are outside the band without the effects and {} with them",
                         c.before_outside, lags, c.after_outside)
           : fmt::format("{} of {} lags are outside the band", outside, lags);
  return fmt::format(
      "{}; chance puts about {:.2g} there. {} Its rms is {:.3g} times that of the noise.", counts,
      kOutsideShare * static_cast<double>(lags),
      !estimator::is_patterned(outside, lags) ? "What is left has no pattern: it looks like noise."
      : level < kNoLouder
          ? "The rest does not exceed noise, so its pattern may be that of the noise."
          : "What is left still follows a pattern, so it is not noise alone.",
      level);
}

std::string residual_section(const DiagnoseOutput& o) {
  const estimator::ResidualCorrelation& c = o.diagnosis.evidence.correlation;
  if (c.lag_s.size() == 0) return "";
  SvgAxis y{"autocorrelation"};
  SvgPlot plot("autocorrelation of what is left", {"lag, s"}, y, kNarrow, kTall - 40);
  const std::vector<double> lag = scaled(c.lag_s, 1);
  plot.add({"before", kLinear, SvgMark::dashed, lag, scaled(c.before, 1)});
  if (has_effects(o) && c.after.size() > 0)
    plot.add({"after", kWithEffects, SvgMark::line, lag, scaled(c.after, 1)});
  plot.add_rule(c.white_band);
  plot.add_rule(-c.white_band);
  plot.describe(residual_sentence(o));
  return "<h2>Is the rest noise?</h2>\n" + html_paragraph(residual_sentence(o)) +
         html_figure({plot.svg()},
                     "Every channel and frequency is divided by the sensors' noise there, mean of "
                     "all channels of the held-out records. Between the dotted lines lie 95 % of "
                     "the values that noise would give.");
}

}  // namespace framewatch::daemon
