// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/model/plant.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Returns the spectra of the axes, corrected for the model's errors of axes (gain, clock,
/// misalignment, exchanged axes): axes x bins.
Eigen::MatrixXcd calibrated(const Model& model, const RecordSegment& segment);

/// Returns the noise variance of every axis in one bin of calibrated(), as acceleration also if the
/// axis measures displacement.
Eigen::VectorXd bin_noise(const Model& model, const RecordSegment& segment, Eigen::Index bin);

/// Measured deformation of an element, at `ratio` steps per sample.
struct MeasuredDeformation {
  Eigen::VectorXd d, v;  ///< m, m/s
};

/// Returns the deformation measured by the axes. motion: spectra in the band, sums over samples of
/// acceleration, m/s^2; axes x bins, then the motions that no axis reads. sense: deformation per
/// motion of the axes.
///
/// Includes the motion above the band if axes read all of it, because a stiff contact is shorter
/// than the band resolves. For a prescribed motion that is measured as displacement it also
/// includes slower motion, because hysteresis remembers it.
MeasuredDeformation measured_deformation(const Plant& plant, const RecordSegment& segment,
                                         const Eigen::RowVectorXd& sense,
                                         const Eigen::MatrixXcd& motion, int ratio);

}  // namespace framewatch::estimator
