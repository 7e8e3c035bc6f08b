// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/refine_command.h"

#include <cmath>
#include <optional>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/exit_code.h"
#include "daemon/base/json.h"
#include "daemon/base/printable.h"
#include "daemon/base/progress.h"
#include "daemon/base/words.h"
#include "daemon/config/sections/config_problems.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/estimation/segment_collector.h"
#include "daemon/tools/replay/refined_segment.h"
#include "daemon/tools/replay/replay_survey.h"
#include "daemon/tools/replay/stored_samples.h"
#include "drivers/lcm/accel_intake.h"
#include "estimator/refine/max_likelihood.h"

namespace framewatch::daemon {
namespace {

constexpr int kNotRefined = 1;

/// Everything that the command prints.
struct Report {
  double from_s = 0, to_s = 0;
  estimator::Refinement refinement;
  std::vector<double> streaming;    ///< theta order; NaN: not published
  std::vector<std::string> silent;  ///< channels without samples, which were left out
};

std::string json(const RefineArguments& a, const Config& config,
                 const estimator::ParameterTable& table, const Report& report) {
  const estimator::Refinement& r = report.refinement;
  Json out{{"schema", "framewatch.refine/1"},
           {"config", a.config},
           {"config_sha256", config.sha256},
           {"inputs", a.inputs},
           {"version", FRAMEWATCH_VERSION},
           {"from_s", report.from_s},
           {"to_s", report.to_s},
           {"prior", a.prior},
           {"channels_without_samples", report.silent},
           {"status", status_word(r.status)}};
  if (r.has_values()) {
    out["iterations"] = r.iterations;
    out["log_likelihood"] = json_value(r.log_likelihood);
    out["misfit_ratio"] = json_value(r.misfit_ratio);
    out["band_hz"] = {r.band.low_hz, r.band.high_hz};
    out["bins"] = r.bins;
    out["parameters"] = Json::array();
    for (int p = 0; p < table.size(); ++p)
      out["parameters"].push_back({{"name", table[p].name},
                                   {"unit", table[p].unit},
                                   {"streaming", json_value(report.streaming[std::size_t(p)])},
                                   {"refined", json_value(r.theta[p])},
                                   {"std_error", json_value(r.std_error[p])},
                                   {"cramer_rao_bound", json_value(r.bound[p])}});
  }
  return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string text(const estimator::ParameterTable& table, const Report& report) {
  const estimator::Refinement& r = report.refinement;
  std::string out =
      fmt::format("{:.3f} s to {:.3f} s: {}\n", report.from_s, report.to_s, status_word(r.status));
  if (!r.has_values()) return out;
  out += fmt::format(
      "{} steps, {:.2f} to {:.2f} Hz, log-likelihood {:.6g}; misfit {:.3g} times what sensor "
      "noise explains\n",
      r.iterations, r.band.low_hz, r.band.high_hz, r.log_likelihood, r.misfit_ratio);
  for (const std::string& name : report.silent)
    out += fmt::format("channel {} has no samples and was left out\n", printable(name));
  out += fmt::format("{:<12} {:>12} {:>12} {:>12} {:>12}  {}\n", "parameter", "streaming",
                     "refined", "std error", "least error", "unit");
  for (int p = 0; p < table.size(); ++p)
    out += fmt::format("{:<12} {:>12} {:>12} {:>12} {:>12}  {}\n", table[p].name,
                       or_dash(report.streaming[std::size_t(p)], "{:.5g}"),
                       or_dash(r.theta[p], "{:.5g}"), or_dash(r.std_error[p], "{:.5g}"),
                       or_dash(r.bound[p], "{:.5g}"), table[p].unit);
  out +=
      "streaming: the last value published by the end of the stretch, or - without one; least "
      "error: Cramer-Rao bound\n";
  return out;
}

}  // namespace

int refine(const RefineArguments& a) {
  std::vector<ConfigProblem> config_problems;
  const std::optional<Config> config = load_config(a.config, config_problems);
  print_problems(config_problems);
  if (!config) return kBadInput;
  const estimator::PipelineConfig& pipeline_config = config->pipeline;
  const double to_s = a.to_s < 0 ? a.from_s + pipeline_config.options.window_s : a.to_s;
  if (!(to_s > a.from_s)) return refuse("refine", "--to must be later than --from");
  ReplaySurvey survey(*config, false);
  survey.declare(a.record);
  for (const std::string& path : a.inputs) survey.add(path);
  survey.finish();
  for (const std::string& note : survey.notes()) fmt::print(stderr, "{}\n", printable_lines(note));
  for (const std::string& problem : survey.problems())
    fmt::print(stderr, "{}\n", printable_lines(problem));
  if (!survey.problems().empty()) return kBadInput;

  const estimator::ParameterTable streamed = pipeline_config.parameters();
  SegmentCollector collector(pipeline_config, a.from_s, to_s);
  std::vector<double> streaming(std::size_t(streamed.size()), std::nan(""));
  const auto take = [&](const estimator::WindowEstimate& estimate) {
    const auto end_us = static_cast<double>(to_microseconds(estimate.end) - collector.first_us());
    if (end_us > 1e6 * to_s + 1) return;
    for (std::size_t p = 0; p < streaming.size(); ++p)
      if (estimate.reason[p] == estimator::Observability::observable)
        streaming[p] = estimate.value[p];
  };
  estimator::Pipeline pipeline(pipeline_config);
  ProgressLine progress("refine", false);
  std::int64_t pushed = 0;
  const auto sink = [&](const estimator::AccelSample& sample) {
    if (++pushed % 1024 == 0)
      progress("reading samples",
               1e-6 * static_cast<double>(to_microseconds(sample.time) - collector.first_us()) /
                   survey.measured_seconds());
    collector.push(sample);
    if (static_cast<double>(to_microseconds(sample.time) - collector.first_us()) <=
        1e6 * (to_s + pipeline_config.options.lateness_s))
      estimator::each_main_window(pipeline.push(sample), take);
  };
  drivers::AccelIntake intake(wanted_axes(*config), sink, intake_settings(*config));
  for (const ReplayInput& input : survey.inputs()) {
    const std::string problem = push_stored_samples(*config, input, intake, sink);
    if (problem.empty()) continue;
    fmt::print(stderr, "{}\n", printable_lines(problem));
    return kBadInput;
  }
  estimator::each_main_window(pipeline.finish(), take);
  collector.finish();

  const RefinedSegment segment =
      without_silent_channels(pipeline_config, collector.axes(), collector.accel());
  const estimator::ParameterTable table = segment.config.parameters();
  const Eigen::VectorXd design = identified_design(segment.config);
  Report report{a.from_s, to_s, {}, {}, segment.silent};
  Eigen::VectorXd start = design;
  for (int p = 0; p < table.size(); ++p) {
    const std::optional<int> same = streamed.find(table[p].name);
    report.streaming.push_back(same ? streaming[std::size_t(*same)] : std::nan(""));
    if (same) start[p] = pipeline.theta0()[*same];
    if (report.streaming.back() > 0) start[p] = report.streaming.back();
  }
  estimator::RefineOptions options;
  progress.part_begins();
  options.progress = [&](int step) {
    progress(fmt::format("step {} of {} at most", step, options.max_iterations), 0);
  };
  // Without drawings the design is a guess, which must not pull the parameters.
  options.prior = a.prior && pipeline_config.options.prior && pipeline_config.design.size() > 0;
  report.refinement = refine_max_likelihood(segment.config, segment.accel,
                                            options.prior ? design : start, start, options);
  fmt::print("{}", a.json ? json(a, *config, table, report) : text(table, report));
  return report.refinement.status == estimator::RefineStatus::converged ? 0 : kNotRefined;
}

}  // namespace framewatch::daemon
