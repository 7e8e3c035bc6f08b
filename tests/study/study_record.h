// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <Eigen/Core>

#include "tests/study/study_case.h"

namespace framewatch::study {

/// Returns the channels of a record without noise and instrument errors, at the sampling rate,
/// filtered if StudyCase::filtered: instants x axes, m/s^2.
Eigen::MatrixXd clean_record(const StudyCase& c, int record);

/// Returns the sampled channels of a record with noise, instants x axes, m/s^2.
Eigen::MatrixXd measured(const StudyCase& c, int record);

/// Writes config.toml, train.csv.gz, holdout.csv.gz and truth.json to `directory`. Returns false
/// and sets `error` if they cannot be written.
bool write_case(const StudyCase& c, const std::string& directory, std::string& error);

}  // namespace framewatch::study
