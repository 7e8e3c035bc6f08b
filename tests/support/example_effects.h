// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/structure/effect.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::test {

/// Two-story table model, one bay each way, flexible floors; its theta and one axis per place.
struct TableModel {
  estimator::Structure structure;
  Eigen::VectorXd theta;
  std::vector<estimator::SensorAxis> axes;

  estimator::ParameterTable table() const { return estimator::ParameterTable(structure); }
};
TableModel table_model(estimator::FloorModel floor = estimator::FloorModel::flexible);

/// Returns an effect of the kind at its first place, visible when frames deform by about 5 mm.
/// `size` scales its strength; 0 means no effect.
estimator::Effect example_effect(estimator::EffectKind kind, const TableModel& model,
                                 double size = 1);

}  // namespace framewatch::test
