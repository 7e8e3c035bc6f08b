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

/// Damping matrix of one effect LawForm::modal_damping, 2 h w M phi phi' M, and of all that a model
/// has: coordinates x coordinates.
Eigen::MatrixXd modal_damping(const Plant& plant, const Model& model, const ModelEffect& effect);
Eigen::MatrixXd modal_damping(const Plant& plant, const Model& model);
/// Whether it has any that is not zero.
bool has_modal_damping(const Model& model);

/// Indices of the effects LawForm::modal_damping of modes whose frequency lies within the band of
/// all records.
std::vector<std::size_t> modes_in_band(const Plant& plant, const Model& model,
                                       const std::vector<RecordSegment>& records);

/// Motion of the coordinates relative to the ground by that of the axes: coordinates x axes.
Eigen::MatrixXd relative_motion(const Plant& plant);

/// The parameter of LawForm::modal_damping.
LawParameter modal_ratio(double value);

}  // namespace framewatch::estimator
