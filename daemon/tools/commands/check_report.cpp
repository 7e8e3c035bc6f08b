// SPDX-License-Identifier: MIT
#include "daemon/tools/commands/check_report.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <fmt/core.h>

#include "daemon/base/words.h"
#include "daemon/tools/commands/layout_warnings.h"
#include "drivers/can/bus_load.h"
#include "estimator/pipeline/pipeline.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::daemon {
namespace {

/// Below this share there is only rounding error.
constexpr double kNoShear = 1e-9;
/// Below this share 1 % sensor noise causes an error of a panel above its value (method.md).
constexpr double kWeakShear = 0.01;
/// The derivative filters' error is small up to a fifth of the sampling rate.
constexpr double kUsableShareOfRate = 0.2;
/// Dense matrices of larger buildings take too long.
constexpr int kMaxDegreesOfFreedom = 400;

/// Returns the bytes that this process has allocated and not freed.
std::size_t allocated_bytes() {
#ifdef __GLIBC__
  const struct mallinfo2 info = ::mallinfo2();
  return info.uordblks + info.hblkhd;
#else
  return 0;
#endif
}

void warn_about_panels(CheckReport& report) {
  std::vector<std::string> no_shear, weak_shear;
  for (const PanelOutlook& panel : report.panels)
    if (panel.shear_ratio < kWeakShear)
      (panel.shear_ratio < kNoShear ? no_shear : weak_shear).push_back(panel.parameter);
  constexpr std::size_t kSome = 6;
  const std::string none = listed(no_shear, kSome, ", {} more"),
                    weak = listed(weak_shear, kSome, ", {} more");
  if (!none.empty())
    report.warnings.push_back(
        "the plan is symmetric in the design's stiffness and mass: ground motion does not shear "
        "the floors, and no record can identify " +
        none + " and their damping");
  if (!weak.empty())
    report.warnings.push_back(
        "the plan is nearly symmetric in the design's stiffness and mass: expect little about " +
        weak + " and their damping");
}

void warn_about_rate(CheckReport& report) {
  const double rate = report.config.pipeline.options.rate_hz;
  const double usable = kUsableShareOfRate * rate;
  const auto& hz = report.design_hz;
  const auto above = std::count_if(hz.begin(), hz.end(), [&](double f) { return f > usable; });
  if (above > 0)
    report.warnings.push_back(fmt::format(
        "{} of {} design natural frequencies lie above a fifth of the sampling rate, {:g} Hz "
        "(highest: {:.2f} Hz); sample at {:.0f} Hz or more",
        above, hz.size(), usable, hz.back(), std::ceil(hz.back() / kUsableShareOfRate)));
}

void warn_about_rounding(CheckReport& report) {
  const estimator::EstimatorOptions& o = report.config.pipeline.options;
  const auto check = [&](const char* key, double asked, int rows) {
    const double got = rows / o.rate_hz;
    if (std::abs(got - asked) > 1e-6 * asked)
      report.warnings.push_back(
          fmt::format("estimator.{}: {:g} s becomes {:.6g} s, {} samples at {:g} Hz", key, asked,
                      got, rows, o.rate_hz));
  };
  check("window_s", o.window_s, report.window_rows);
  check("hop_s", o.hop_s, report.hop_rows);
}

void warn_about_bus_load(CheckReport& report) {
  for (std::size_t b = 0; b < report.config.can.buses.size(); ++b) {
    const double share = drivers::bus_load(report.config.can, static_cast<int>(b)).share;
    if (share > drivers::kHighBusLoad)
      report.warnings.push_back(fmt::format(
          "the configured nodes may take {:.0f} % of {}: above {:.0f} % frames wait long "
          "and other devices suffer; a higher bit rate, a second bus or fewer nodes help",
          100 * share, report.config.can.buses[b].interface, 100 * drivers::kHighBusLoad));
  }
}

void warn_about_force(CheckReport& report) {
  const estimator::PipelineConfig& c = report.config.pipeline;
  const bool rests = std::none_of(c.axes.begin(), c.axes.end(), [](const estimator::SensorAxis& a) {
    return a.story == 0 && a.horizontal();
  });
  if (rests)
    report.warnings.push_back(
        "no base channel: the base is taken to rest while a force drives the building");
  if (c.structure.panels() > 0)
    report.warnings.push_back(
        "with a force the floor panels are not identified: they are as stiff as the design says");
  report.warnings.push_back(
      "how well a test with a force shows its parameters is not predicted: the standard errors of "
      "its windows say it");
}

/// Warns of tall or slender frames, which bend as a whole because their columns change length.
void warn_about_bending(CheckReport& report) {
  const estimator::PipelineConfig& c = report.config.pipeline;
  const estimator::Structure& s = c.structure;
  const double height = std::accumulate(s.story_height.begin(), s.story_height.end(), 0.0);
  for (const estimator::Direction along : {estimator::Direction::x, estimator::Direction::y}) {
    const bool x = along == estimator::Direction::x;
    if ((x ? s.n() : s.m()) == 0 || c.bending_nmprad[x ? 0 : 1] > 0) continue;
    if (!bends_as_a_whole(s, along)) continue;
    const std::vector<double>& spans = x ? s.span_x : s.span_y;
    const double width = std::accumulate(spans.begin(), spans.end(), 0.0);
    report.warnings.push_back(fmt::format(
        "frames parallel to {0} of {1} stories, {2:.3g} m high{3}: such frames bend as a whole, "
        "and "
        "a model without it finds upper stories too soft; give kr{0}_nmprad in [structure.design], "
        "or compare what framewatch refine leaves of the first strong record without and with it",
        letter(along), s.stories, height,
        width > 0 ? fmt::format(" and {:.3g} m wide", width) : std::string()));
  }
}

}  // namespace

CheckReport make_check_report(const Config& config, int advise) {
  CheckReport report;
  report.config = config;
  const estimator::PipelineConfig& c = config.pipeline;
  const std::size_t before = allocated_bytes();
  const estimator::Pipeline pipeline(c);
  report.memory_bytes = allocated_bytes() - before;
  report.window_rows = pipeline.window_rows();
  report.hop_rows = pipeline.hop_rows();
  const estimator::ParameterTable table(c.structure), identified = c.parameters();
  for (int i = 0; i < identified.size(); ++i) report.parameters.push_back(identified[i].name);
  if (has_force(c.axes)) {
    warn_about_force(report);
  } else if (identified.grouped()) {
    report.layout = layout_outlook(config, advise);
    report.warnings = layout_warnings(config, *report.layout);
  }
  for (const ConfigProblem& doubt : config.doubts)
    report.warnings.push_back(fmt::format("{}: {}", doubt.where, doubt.message));
  warn_about_bending(report);
  warn_about_rounding(report);
  warn_about_bus_load(report);
  const bool small = c.structure.degrees_of_freedom() <= kMaxDegreesOfFreedom;
  if (c.design.size() > 0 && small) {
    report.design_hz = natural_frequencies_hz(c.structure, table, c.design);
    const std::vector<double> shares = panel_excitation(c.structure, table, c.design);
    const int first = table.elements() - static_cast<int>(shares.size());
    for (std::size_t p = 0; p < shares.size(); ++p)
      report.panels.push_back({table[first + static_cast<int>(p)].name, shares[p]});
    if (!identified.grouped()) warn_about_panels(report);
    warn_about_rate(report);
  }
  return report;
}

}  // namespace framewatch::daemon
