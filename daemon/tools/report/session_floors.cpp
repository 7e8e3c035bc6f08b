// SPDX-License-Identifier: MIT
#include "daemon/tools/report/session_floors.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/json.h"
#include "daemon/base/numbers.h"
#include "daemon/monitor/estimates/parameter_summary.h"
#include "daemon/monitor/events/event_messages.h"
#include "estimator/identify/elements/story_design.h"
#include "estimator/motion/noise_meter.h"
#include "estimator/numeric/nan.h"
#include "estimator/structure/group_design.h"

namespace framewatch::daemon {
namespace {

using Eigen::Index;

constexpr double kBegins = 0.05, kEnds = 0.95;  // of the Arias intensity
constexpr double kLongestStrong_s = 300;
constexpr double kLead_s = 60, kTail_s = 10;  // so that filters and inner floors settle

void take(double value, std::size_t p, SessionFloors& out) {
  if (!(value > 0)) return;
  out.theta[p] = value;
  out.identified[p] = 1;
}

void choose_parameters(const Config& config, const SessionEstimates& estimates,
                       SessionFloors& out) {
  const estimator::PipelineConfig& c = config.pipeline;
  const estimator::ParameterTable table = c.parameters();
  const Eigen::VectorXd design = group_parameters(c.structure, table, estimator::story_design(c));
  out.theta.assign(design.begin(), design.end());
  out.identified.assign(out.theta.size(), 0);
  const WindowRange strong = windows_within(estimates, out.from_us, out.to_us);
  const WindowRange all{0, estimates.windows()};
  for (std::size_t p = 0; p < out.theta.size(); ++p) {
    const estimator::Parameter& parameter = table[static_cast<int>(p)];
    const auto bending = table.find(parameter.direction == estimator::Direction::x ? "krx" : "kry");
    if (bending && !parameter.frames.empty()) {  // panels do not bend
      take(parameter.kind == estimator::ParameterKind::bending_stiffness
               ? last_value(estimates, p)
               : summarise(estimates, p, all).boxplot.median,
           p, out);
      continue;
    }
    take(summarise(estimates, p, strong).boxplot.median, p, out);
    if (out.identified[p] == 0) take(summarise(estimates, p, all).boxplot.median, p, out);
  }
}

/// Passes every row of the motion to `response` and `peak`, and calls `each` after each row.
template <typename Each>
void replay_motion(const SessionMotion& m, estimator::StoryResponse& response,
                   estimator::PeakResponse& peak, const Each& each) {
  estimator::SampleSet set;
  set.accel.resize(m.axes.size());
  for (Index row = 0; row < m.accel.rows(); ++row) {
    set.index = row;
    set.time = estimator::from_microseconds(m.time_us(row));
    for (std::size_t a = 0; a < m.axes.size(); ++a)
      set.accel[a] = m.accel(row, static_cast<Index>(a));
    response.push(set);
    peak.take(response);
    each();
  }
}

/// Returns the parameters as an estimate that StoryResponse can follow.
estimator::WindowEstimate as_estimate(const std::vector<double>& theta) {
  estimator::WindowEstimate out;
  out.status = estimator::WindowStatus::valid;
  out.value = theta;
  out.reason.assign(theta.size(), estimator::Observability::observable);
  return out;
}

void find_peaks(const Config& config, const SessionMotion& m, SessionFloors& out) {
  const estimator::Structure& s = config.pipeline.structure;
  estimator::StoryResponse response(config.pipeline);
  response.follow(as_estimate(out.theta));
  out.peak = {m.axes.size(), static_cast<std::size_t>(s.degrees_of_freedom())};
  out.peak_accel_mps2.assign(static_cast<std::size_t>(s.stories) + 1,
                             {estimator::kNaN, estimator::kNaN});
  replay_motion(m, response, out.peak, [&] {
    for (int floor = 0; floor <= s.stories; ++floor)
      for (int f = 0; f < s.frames(); ++f) {
        double& peak = out.peak_accel_mps2[static_cast<std::size_t>(floor)]
                                          [s.direction(f) == estimator::Direction::x ? 0 : 1];
        const double now = std::abs(response.floor_accel_mps2(floor, f));
        if (std::isfinite(now) && !(now <= peak)) peak = now;
      }
  });
}

/// Returns the configured noise densities, or those that the record shows in a band without motion.
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

/// Returns the medians of the strong windows as an estimate that StoryResponse can follow.
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

/// Returns the gravest lasting loss in words; "" without one.
std::string loss_words(const SessionEstimates& e, const std::vector<ElementChange>& changes) {
  const auto gravest = std::min_element(
      changes.begin(), changes.end(),
      [](const ElementChange& a, const ElementChange& b) { return a.ratio < b.ratio; });
  if (gravest == changes.end() || !(gravest->ratio < 0)) return "";
  return fmt::format("{} lost {:.1f} % of stiffness", element_words(e.table, gravest->parameter),
                     -100 * gravest->ratio);
}

/// Returns the first row and the row after the last between which the highest measured floor has 5
/// to 95 % of its Arias intensity.
std::pair<Index, Index> strong_rows(const SessionMotion& m) {
  int top = 0;
  for (const estimator::SensorAxis& axis : m.axes)
    if (!axis.is_force) top = std::max(top, axis.story);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(m.accel.rows());
  for (std::size_t a = 0; a < m.axes.size(); ++a) {
    if (m.axes[a].story != top || m.axes[a].is_force) continue;
    const auto column = m.accel.col(static_cast<Index>(a)).array();
    const auto known = column.isFinite();
    const double mean =
        known.select(column, 0).sum() / static_cast<double>(std::max<Index>(known.count(), 1));
    sum += known.select(column - mean, 0).square().matrix();
  }
  for (Index i = 1; i < sum.size(); ++i) sum[i] += sum[i - 1];
  const auto row = [&](double share) {
    return static_cast<Index>(
        std::lower_bound(sum.begin(), sum.end(), share * sum[sum.size() - 1]) - sum.begin());
  };
  const Index first = row(kBegins);
  return {first, std::clamp<Index>(row(kEnds), first + 1,
                                   first + static_cast<Index>(kLongestStrong_s * m.rate_hz))};
}

}  // namespace

SessionFloors session_floors(const Config& config, const SessionMotion& m,
                             const SessionEstimates& estimates) {
  const estimator::Structure& s = config.pipeline.structure;
  SessionFloors out;
  const auto [first, end] = strong_rows(m);
  out.from_us = m.time_us(first);
  out.to_us = m.time_us(end);
  out.measured.assign(static_cast<std::size_t>(s.stories) + 1, {false, false});
  for (const estimator::SensorAxis& axis : m.axes)
    if (!axis.is_force)
      out.measured[static_cast<std::size_t>(axis.story)]
                  [static_cast<std::size_t>(direction_of(s, axis))] = true;
  choose_parameters(config, estimates, out);
  find_peaks(config, m, out);
  const Eigen::Map<const Eigen::VectorXd> theta(out.theta.data(), std::ssize(out.theta));
  const Index from = std::max<Index>(0, first - static_cast<Index>(kLead_s * m.rate_hz));
  const Index to = std::min<Index>(m.accel.rows(), end + static_cast<Index>(kTail_s * m.rate_hz));
  out.left_out = leave_floors_out(config.pipeline, theta, m.accel.middleRows(from, to - from),
                                  first - from, end - from);
  return out;
}

std::vector<int> framed_directions(const estimator::Structure& s) {
  std::vector<int> out;
  if (s.n() > 0) out.push_back(0);
  if (s.m() > 0) out.push_back(1);
  return out;
}

double peak_drift_ratio(const SessionFloors& floors, const estimator::Structure& s, int story,
                        int along) {
  double most = estimator::kNaN;
  for (int f = 0; f < s.frames(); ++f) {
    if ((s.direction(f) == estimator::Direction::x ? 0 : 1) != along) continue;
    const double drift = floors.peak.drift_m[static_cast<std::size_t>(s.dof(story, f))];
    if (std::isfinite(drift) && !(drift <= most)) most = drift;
  }
  return most / s.story_height[static_cast<std::size_t>(story - 1)];
}

std::string floors_json(const SessionFloors& floors, const Config& config,
                        const SessionMotion& motion) {
  const estimator::Structure& s = config.pipeline.structure;
  const estimator::ParameterTable table = config.pipeline.parameters();
  const auto seconds = [&](std::int64_t us) {
    return 1e-6 * static_cast<double>(us - motion.first_us);
  };
  Json out{{"schema", "framewatch.floors/1"},   {"config_sha256", config.sha256},
           {"version", FRAMEWATCH_VERSION},     {"structure", s.name},
           {"from_s", seconds(floors.from_us)}, {"to_s", seconds(floors.to_us)},
           {"parameters", Json::array()},       {"floors", Json::array()},
           {"left_out", Json::array()}};
  for (int p = 0; p < table.size(); ++p)
    out["parameters"].push_back({{"name", table[p].name},
                                 {"unit", table[p].unit},
                                 {"value", json_value(floors.theta[std::size_t(p)])},
                                 {"identified", floors.identified[std::size_t(p)] != 0}});
  for (int floor = 0; floor <= s.stories; ++floor) {
    Json one{{"floor", floor}};
    for (const int along : framed_directions(s)) {
      const auto at = static_cast<std::size_t>(floor), d = static_cast<std::size_t>(along);
      one[along == 0 ? "x" : "y"] = {
          {"measured", floors.measured[at][d]},
          {"peak_accel_mps2", json_value(floors.peak_accel_mps2[at][d])},
          {"peak_drift_ratio_below",
           json_value(floor > 0 ? peak_drift_ratio(floors, s, floor, along) : estimator::kNaN)}};
    }
    out["floors"].push_back(std::move(one));
  }
  for (const estimator::LeftOutFloor& one : floors.left_out)
    out["left_out"].push_back({{"floor", one.floor},
                               {"direction", letter(one.direction)},
                               {"error_ratio", json_value(one.error)},
                               {"error_below_5_hz_ratio", json_value(one.low_error)},
                               {"spline_error_ratio", json_value(one.spline)},
                               {"spline_error_below_5_hz_ratio", json_value(one.low_spline)}});
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

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
  replay_motion(m, response, peak, [] {});
  estimator::DriftKnowledge known = response.knowledge();
  known.noise_density = session_noise(m);
  return drift_report(config, pipeline, peak, known, loss_words(estimates, changes));
}

}  // namespace framewatch::daemon
