// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/replayed_estimates.h"

#include <algorithm>
#include <cstddef>

#include "daemon/monitor/estimation/estimation.h"
#include "daemon/tools/replay/replay_summary.h"
#include "daemon/tools/replay/replay_survey.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

class ArrayListener : public EstimationListener {
 public:
  explicit ArrayListener(EstimateArrays& arrays) : arrays_(arrays) {}
  void on_estimate(const estimator::WindowEstimate& estimate) override { arrays_.add(estimate); }

 private:
  EstimateArrays& arrays_;
};

}  // namespace

void EstimateArrays::add(const estimator::WindowEstimate& e) {
  start_us.push_back(to_microseconds(e.start));
  end_us.push_back(to_microseconds(e.end));
  sequence.push_back(e.sequence);
  status.push_back(static_cast<std::uint8_t>(e.status));
  rows.push_back(e.rows);
  residual_ratio.push_back(e.residual_ratio);
  for (std::size_t p = 0; p < e.value.size(); ++p) {
    const bool observable = e.reason[p] == estimator::Observability::observable;
    value.push_back(observable ? e.value[p] : estimator::kNaN);
    std_error.push_back(observable ? e.std_error[p] : estimator::kNaN);
    reason.push_back(static_cast<std::uint8_t>(e.reason[p]));
  }
}

ReplayedEstimates replay_estimates(const Config& config, const TuningInput& input, bool one_pass,
                                   const ReplayStep& step) {
  Config used = config;
  used.pipeline.options.boxplot_windows = 0;
  const auto bytes = static_cast<double>(std::max<std::int64_t>(input.bytes(), 1));
  const auto tell = [&](const char* what, std::int64_t done) {
    if (step) step(what, std::min(static_cast<double>(done) / bytes, 1.0));
  };
  ReplayedEstimates out;
  ArrayListener listener(out.arrays);
  Estimation estimation(used, {}, &listener);
  if (!one_pass && can_be_tuned(used)) {
    const FirstPasses first(used, input, [&](std::int64_t done) { tell("tuning", done); });
    if (first.tuning()) estimation.start_tuned(*first.tuning());
    if (first.read()) out.notes.push_back(first.note());
  }
  ReplaySurvey survey(used, input.salvage, input.span);
  survey.declare(input.record);
  survey.feed(estimation);
  survey.at_each([&](std::int64_t done, std::int64_t) { tell("replay", done); });
  input.add_to(survey);
  survey.finish();
  estimation.finish();
  out.notes.insert(out.notes.end(), survey.notes().begin(), survey.notes().end());
  out.problems = survey.problems();
  if (!out.problems.empty()) out.arrays = {};
  if (out.problems.empty() && out.arrays.end_us.empty())
    out.notes.push_back(why_no_window(used, estimation, survey.measured_seconds()));
  return out;
}

}  // namespace framewatch::daemon
