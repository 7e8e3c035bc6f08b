// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "tests/study/study_case.h"

namespace framewatch::study {

/// Returns the channels of a record without noise and instrument errors, at the sampling rate,
/// filtered if StudyCase::filtered: instants x axes, m/s^2.
Eigen::MatrixXd clean_record(const StudyCase& c, int record);

}  // namespace framewatch::study
