#pragma once

#include <string>
#include <vector>

#include "daemon/config.h"
#include "daemon/diagnose_records.h"
#include "estimator/diagnose/diagnosis.h"

namespace framewatch::daemon {

/// What the outputs of a diagnosis are made from.
struct DiagnoseOutput {
  const Config& config;
  const Plant& plant;
  const std::vector<DiagnoseRecord>& records;  ///< training first
  const std::vector<Stretch>& stretches;
  std::size_t holdout_from;
  const Diagnosis& diagnosis;
};

/// framewatch.diagnosis/1.
std::string diagnosis_json(const DiagnoseOutput& output);
/// The configuration with the identified values as its design and the effects as [[effect]].
std::string diagnosis_model_toml(const DiagnoseOutput& output);
/// A self-contained page.
std::string diagnosis_report(const DiagnoseOutput& output);
/// One line a person reads.
std::string diagnosis_text(const DiagnoseOutput& output);

}  // namespace framewatch::daemon
