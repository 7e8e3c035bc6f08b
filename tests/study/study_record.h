#pragma once

#include <Eigen/Core>

#include "tests/study/study_case.h"

namespace framewatch::study {

/// Channels of a record without noise and without the small errors of every instrument, at the
/// sampling rate, filtered where StudyCase::filtered says so: instants x axes, m/s^2.
Eigen::MatrixXd clean_record(const StudyCase& c, int record);

}  // namespace framewatch::study
