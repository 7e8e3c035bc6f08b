#pragma once

#include <Eigen/Core>

#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Spectra of the axes, freed from the errors that the model gives them (gain, clock, misalignment,
/// exchanged axes): axes x bins.
Eigen::MatrixXcd calibrated(const Model& model, const RecordSegment& segment);

/// Variance of every axis' noise in one bin of calibrated(); of acceleration where the axis
/// measures displacement.
Eigen::VectorXd bin_noise(const Model& model, const RecordSegment& segment, Eigen::Index bin);

}  // namespace framewatch::estimator
