// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/tools/diagnosis/diagnose_records.h"
#include "daemon/tools/diagnosis/diagnose_verdict.h"
#include "estimator/diagnose/fit/diagnosis_input.h"
#include "estimator/diagnose/model/plant.h"
#include "estimator/diagnose/verdict/diagnosis.h"

namespace framewatch::daemon {

struct DiagnoseArguments {
  std::string config;
  std::vector<std::string> train, holdout;  ///< record files and LCM event logs
  std::string event;   ///< id of a gap event whose stored samples replace these files
  std::string design;  ///< folder with matrices of the design; empty: the configuration's
  std::string out;     ///< directory for diagnosis.json, report.html, model.toml
  std::vector<std::string> without;   ///< names of effects to exclude
  std::vector<std::string> settings;  ///< numbers of the search, NAME=VALUE
  estimator::ComponentTest component;
  int threads = 0;     ///< 0: as many as the machine has
  double limit_s = 0;  ///< of the diagnosis, in which it must end its search; 0: none
  bool quiet = false;
};

/// A diagnosis with everything that it was made from.
struct DiagnosisRun {
  const Config& config;  ///< outlives this
  std::vector<DiagnoseRecord> records;
  estimator::DiagnosisInput input;
  std::size_t holdout_from;  ///< index of the first held-out record
  estimator::Diagnosis diagnosis;

  DiagnoseOutput output() const {
    return {config, input.plant, records, input.segments, holdout_from, diagnosis};
  }
};

/// Functions that run_diagnosis() calls; both may be empty.
struct DiagnosisHooks {
  /// Gets the current work and the share of the whole that is done, 0 to 1. Called by one thread at
  /// a time.
  std::function<void(const std::string& what, double share)> progress;
  /// Called before every piece of parallel work, by several threads at once. May throw to end the
  /// diagnosis: run_diagnosis() rethrows.
  std::function<void()> check;
};

/// Diagnoses the records of `arguments`, whose config, out and quiet are not used. Returns nullptr
/// and appends every problem to `problems` if an argument or a record is invalid.
std::unique_ptr<DiagnosisRun> run_diagnosis(const Config& config,
                                            const DiagnoseArguments& arguments,
                                            const DiagnosisHooks& hooks,
                                            std::vector<std::string>& problems);

}  // namespace framewatch::daemon
