// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Undamped modes of a model's elements and rotations, without its other effects.
struct ModelModes {
  Eigen::VectorXd w;       ///< rad/s, ascending
  Eigen::MatrixXd shapes;  ///< coordinates x modes, phi' M phi = 1
  Eigen::VectorXd mass;    ///< of the coordinates, kg
};
ModelModes modes_of(const Plant& plant, const Model& model);

/// Returns the damping matrix 2 h w M phi phi' M of one effect LawForm::modal_damping, or the sum
/// over all of a model: coordinates x coordinates.
Eigen::MatrixXd modal_damping(const Plant& plant, const Model& model, const ModelEffect& effect);
Eigen::MatrixXd modal_damping(const Plant& plant, const Model& model);
/// Returns true if a modal damping ratio of the model is not zero.
bool has_modal_damping(const Model& model);

/// Returns the indices of the effects LawForm::modal_damping whose mode lies within the band of all
/// records.
std::vector<std::size_t> modes_in_band(const Plant& plant, const Model& model,
                                       const std::vector<RecordSegment>& records);

/// Returns the matrix from the axes' motion to the coordinates' motion relative to the ground:
/// coordinates x axes.
Eigen::MatrixXd relative_motion(const Plant& plant);

/// Returns the parameter of LawForm::modal_damping.
LawParameter modal_ratio(double value);

}  // namespace framewatch::estimator
