#include "daemon/tools/report/session_drifts.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/base/numbers.h"
#include "daemon/monitor/estimates/parameter_summary.h"
#include "daemon/monitor/estimates/settled_windows.h"
#include "daemon/monitor/events/event_words.h"
#include "daemon/tools/report/session_floors.h"
#include "estimator/motion/noise_meter.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

using Eigen::Index;

/// Configured noise, or what the record shows in a band without motion.
std::vector<double> session_noise(const SessionMotion& m) {
  std::vector<double> out = noise_densities(m.axes);
  estimator::NoiseMeter meter(static_cast<int>(m.axes.size()), m.rate_hz);
  std::vector<double> row(m.axes.size());
  for (Index i = 0; i < m.accel.rows(); ++i) {
    for (std::size_t a = 0; a < row.size(); ++a) row[a] = m.accel(i, static_cast<Index>(a));
    meter.push(row);
  }
  for (std::size_t a = 0; a < out.size(); ++a)
    if (const double measured = meter.density(static_cast<int>(a));
        m.axes[a].noise_density == 0 && measured > 0)
      out[a] = measured;
  return out;
}

/// What StoryResponse follows: medians of the strong windows.
estimator::WindowEstimate strong_estimate(const SessionEstimates& e, const WindowRange& strong) {
  estimator::WindowEstimate out(e.parameters());
  out.status = estimator::WindowStatus::valid;
  const WindowRange all{0, e.windows()};
  for (std::size_t p = 0; p < e.parameters(); ++p) {
    const ParameterSummary inside = summarise(e, p, strong);
    const ParameterSummary& s = inside.boxplot.median > 0 ? inside : summarise(e, p, all);
    out.value[p] = s.boxplot.median;
    out.std_error[p] = s.std_error;
    out.reason[p] = s.boxplot.median > 0 ? estimator::Observability::observable
                                         : estimator::Observability::quiet;
  }
  std::vector<double> misfits;
  for (std::size_t w = strong.from; w < strong.to; ++w)
    if (std::isfinite(e.residual_ratio[w])) misfits.push_back(e.residual_ratio[w]);
  out.residual_ratio = misfits.empty() ? estimator::kNaN : median(misfits);
  return out;
}

/// The gravest lasting loss, in words; empty: none.
std::string loss_words(const SessionEstimates& e, const std::vector<ElementChange>& changes) {
  const auto gravest = std::min_element(
      changes.begin(), changes.end(),
      [](const ElementChange& a, const ElementChange& b) { return a.ratio < b.ratio; });
  if (gravest == changes.end() || !(gravest->ratio < 0)) return "";
  return fmt::format("{} lost {:.1f} % of stiffness", element_words(e.table, gravest->parameter),
                     -100 * gravest->ratio);
}

}  // namespace

DriftReport session_drifts(const Config& config, const SessionMotion& m,
                           const SessionEstimates& estimates,
                           const std::vector<ElementChange>& changes) {
  estimator::PipelineConfig pipeline = config.pipeline;
  pipeline.axes = m.axes;
  const auto [first, end] = strong_rows(m);
  estimator::StoryResponse response(pipeline);
  response.follow(
      strong_estimate(estimates, windows_within(estimates, m.time_us(first), m.time_us(end))));
  estimator::PeakResponse peak(m.axes.size(),
                               static_cast<std::size_t>(pipeline.structure.degrees_of_freedom()));
  estimator::SampleSet set;
  set.accel.resize(m.axes.size());
  for (Index row = 0; row < m.accel.rows(); ++row) {
    set.index = row;
    set.time = estimator::from_microseconds(m.time_us(row));
    for (std::size_t a = 0; a < m.axes.size(); ++a)
      set.accel[a] = m.accel(row, static_cast<Index>(a));
    response.push(set);
    peak.take(response);
  }
  estimator::DriftKnowledge known = response.knowledge();
  known.noise_density = session_noise(m);
  return drift_report(config, pipeline, peak, known, loss_words(estimates, changes));
}

}  // namespace framewatch::daemon
