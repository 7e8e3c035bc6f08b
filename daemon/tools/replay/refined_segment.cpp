// SPDX-License-Identifier: MIT
#include "daemon/tools/replay/refined_segment.h"

#include "estimator/identify/elements/story_design.h"
#include "estimator/structure/group_design.h"

namespace framewatch::daemon {

RefinedSegment without_silent_channels(const estimator::PipelineConfig& config,
                                       const std::vector<estimator::SensorAxis>& axes,
                                       const Eigen::MatrixXd& accel) {
  RefinedSegment out{config, {}, {}};
  std::vector<Eigen::Index> kept;
  out.config.axes.clear();
  for (Eigen::Index a = 0; a < accel.cols(); ++a) {
    const estimator::SensorAxis& axis = axes[static_cast<std::size_t>(a)];
    if (accel.col(a).array().isNaN().all() && !axis.is_force) {
      out.silent.push_back(axis.name);
      continue;
    }
    kept.push_back(a);
    out.config.axes.push_back(axis);
  }
  if (!out.silent.empty() && !find_problems(config.structure, out.config.axes).empty())
    return {config, accel, {}};
  for (estimator::SensorAxis& axis : out.config.axes) axis.cross = -1;  // corrected already
  out.accel = accel(Eigen::all, kept);
  return out;
}

Eigen::VectorXd identified_design(const estimator::PipelineConfig& c) {
  const estimator::ParameterTable table = c.parameters();
  const estimator::GroupDesign design = estimator::story_design(c);
  return table.grouped() ? group_parameters(c.structure, table, design) : design.theta;
}

}  // namespace framewatch::daemon
