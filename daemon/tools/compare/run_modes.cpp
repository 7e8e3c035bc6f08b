// SPDX-License-Identifier: MIT
#include "daemon/tools/compare/run_modes.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>
#include <Eigen/Core>

#include "daemon/tools/replay/refined_segment.h"
#include "daemon/tools/report/record_modes.h"
#include "estimator/identify/elements/story_design.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

/// Returns the modes of the forced stage after the last change, or of the one without a change.
const RecordModes* last_stage(const SessionReport& r) {
  const RecordModes* out = nullptr;
  for (const StageModes& of : r.modes)
    if (out == nullptr || r.compared[of.stage].after) out = &of.modes;
  return out;
}

std::vector<RunMode> natural_only(const estimator::NaturalModes& modes) {
  std::vector<RunMode> out;
  for (const estimator::NaturalMode& mode : modes.modes)
    out.push_back({mode, estimator::kNaN, estimator::kNaN, estimator::kNaN});
  return out;
}

std::vector<RunMode> of_record(const RecordModes& m) {
  std::vector<RunMode> out = natural_only(m.identified);
  for (const ModeRow& row : m.rows) {
    if (row.identified < 0 || row.measured < 0) continue;
    const estimator::MeasuredMode& measured = m.measured[static_cast<std::size_t>(row.measured)];
    RunMode& mode = out[static_cast<std::size_t>(row.identified)];
    mode.measured_hz = measured.frequency_hz;
    mode.measured_damping_ratio = measured.damping_ratio;
    mode.mac_measured = row.mac_measured;
  }
  return out;
}

/// Returns the modes of the values, with the design where a value is missing.
RunModes of_values(const SessionReport& r, const std::vector<estimator::WindowMean>& values) {
  if (!r.config) return {{}, "it has no configuration; give --config"};
  const estimator::PipelineConfig& c = r.config->pipeline;
  const estimator::ParameterTable table = c.parameters();
  Eigen::VectorXd theta = Eigen::VectorXd::Constant(table.size(), estimator::kNaN);
  if (c.design.size() > 0) theta = identified_design(c);
  Eigen::VectorXd error(table.size());
  for (int p = 0; p < table.size(); ++p) {
    error[p] = estimator::design_tolerance(table[p].kind) * theta[p];
    const std::vector<std::string>& names = r.estimates.table.name;
    const auto at = std::find(names.begin(), names.end(), table[p].name) - names.begin();
    if (static_cast<std::size_t>(at) < values.size())
      if (const estimator::WindowMean& mean = values[static_cast<std::size_t>(at)];
          mean.value > 0) {
        theta[p] = mean.value;
        error[p] = mean.std_error;
      }
    if (!(theta[p] > 0))
      return {{}, fmt::format("{} is known neither from windows nor from a design", table[p].name)};
  }
  const bool exact = !(error.array() > 0).any();
  Eigen::MatrixXd covariance;
  if (!exact) covariance = error.cwiseAbs2().asDiagonal();
  RunModes out{natural_only(natural_modes(c.structure, table, estimator::story_design(c), theta,
                                          covariance)),
               ""};
  if (exact)
    for (RunMode& mode : out.modes)
      mode.natural.frequency_error_hz = mode.natural.damping_error = 0;
  if (out.modes.empty())
    out.none = fmt::format("the building has more than {} degrees of freedom, or is overdamped",
                           estimator::kMostModalFreedoms);
  return out;
}

}  // namespace

RunModes run_modes(const SessionReport& r, const std::vector<estimator::WindowMean>& values) {
  const RecordModes* record = last_stage(r);
  if (record != nullptr && !record->identified.modes.empty()) return {of_record(*record), ""};
  return of_values(r, values);
}

std::vector<estimator::ComparedMode> compared_modes(const std::vector<RunMode>& modes) {
  std::vector<estimator::ComparedMode> out;
  for (const RunMode& mode : modes)
    out.push_back({mode.natural.frequency_hz, mode.natural.shape, mode.natural.first_equal,
                   mode.natural.last_equal});
  return out;
}

}  // namespace framewatch::daemon
