// SPDX-License-Identifier: MIT
#include "estimator/structure/group_design.h"

namespace framewatch::estimator {

Eigen::VectorXd group_parameters(const Structure& s, const ParameterTable& table,
                                 const GroupDesign& design) {
  const ParameterTable stories(s);
  Eigen::VectorXd out(table.size());
  for (int p = 0; p < table.size(); ++p) {
    const Parameter& group = table[p];
    if (group.kind == ParameterKind::bending_stiffness) {
      out[p] = design.bending_nmprad[group.direction == Direction::x ? 0 : 1];
      continue;
    }
    double flexibility = 0;
    for (int story = group.story; story <= group.last_story; ++story) {
      double sum = 0;
      for (const int f : group.frames)
        sum += design.theta[group.kind == ParameterKind::frame_stiffness
                                ? stories.frame_stiffness(story, f)
                                : stories.frame_damping(story, f)];
      flexibility += 1 / sum;
    }
    out[p] = 1 / flexibility;
  }
  return out;
}

Eigen::VectorXd story_parameters(const Structure& s, const ParameterTable& table,
                                 const GroupDesign& design, const Eigen::VectorXd& of_groups) {
  const ParameterTable stories(s);
  const Eigen::VectorXd designed = group_parameters(s, table, design);
  Eigen::VectorXd out = design.theta;
  for (int p = 0; p < table.size(); ++p) {
    const Parameter& group = table[p];
    if (group.kind == ParameterKind::bending_stiffness) continue;
    for (int story = group.story; story <= group.last_story; ++story)
      for (const int f : group.frames)
        out[group.kind == ParameterKind::frame_stiffness ? stories.frame_stiffness(story, f)
                                                         : stories.frame_damping(story, f)] *=
            of_groups[p] / designed[p];
  }
  return out;
}

}  // namespace framewatch::estimator
