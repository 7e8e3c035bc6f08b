#pragma once

#include <vector>

#include "daemon/config/config.h"
#include "daemon/tools/diagnosis/diagnose_records.h"
#include "estimator/diagnose/fit/diagnosis_input.h"
#include "estimator/diagnose/verdict/diagnosis.h"

namespace framewatch::daemon {

/// Everything that the outputs of a diagnosis are made from.
struct DiagnoseOutput {
  const Config& config;
  const estimator::Plant& plant;
  const std::vector<DiagnoseRecord>& records;  ///< training records first
  const std::vector<estimator::RecordSegment>& segments;
  std::size_t holdout_from;  ///< first record that is held out
  const estimator::Diagnosis& diagnosis;
};

}  // namespace framewatch::daemon
