#pragma once

#include <Eigen/Core>

#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Returns the spectra of the axes, corrected for the model's errors of axes (gain, clock,
/// misalignment, exchanged axes): axes x bins.
Eigen::MatrixXcd calibrated(const Model& model, const RecordSegment& segment);

/// Returns the noise variance of every axis in one bin of calibrated(), as acceleration also if the
/// axis measures displacement.
Eigen::VectorXd bin_noise(const Model& model, const RecordSegment& segment, Eigen::Index bin);

}  // namespace framewatch::estimator
