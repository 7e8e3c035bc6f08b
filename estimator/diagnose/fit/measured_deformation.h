#pragma once

#include <Eigen/Core>

#include "estimator/diagnose/model/plant.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Of an element as it was measured, at `ratio` steps per sample.
struct MeasuredDeformation {
  Eigen::VectorXd d, v;  ///< m, m/s
};

/// motion: spectra in the band, sums of samples of acceleration, m/s^2; axes x bins. sense: over
/// the axes, their motion to the deformation's. Behind the axes, motions that none reads.
///
/// What lies above the band belongs to it, where axes read all of it: a stiff contact is shorter
/// than the band is wide. Of a prescribed motion, measured as displacement, what is slower than the
/// band does too, since hysteresis remembers it.
MeasuredDeformation measured_deformation(const Plant& plant, const RecordSegment& segment,
                                         const Eigen::RowVectorXd& sense,
                                         const Eigen::MatrixXcd& motion, int ratio);

}  // namespace framewatch::estimator
