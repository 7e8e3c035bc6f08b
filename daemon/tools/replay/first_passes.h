// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/tools/replay/replay_survey.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::daemon {

/// A record in memory, and its name in messages.
struct NamedRecord {
  std::string name;
  drivers::Record record;
};

/// Input of a replay, which FirstPasses tunes on.
struct TuningInput {
  std::vector<std::string> paths;   ///< logs and record files, in order of time
  RecordFileArguments record = {};  ///< options that record files do not state themselves
  bool salvage = false;             ///< damaged input is skipped instead of refused
  ReplaySpan span = {};
  std::vector<NamedRecord> records = {};  ///< follow the files, in order of time

  /// Passes every file and record to `survey`, in their order.
  void add_to(ReplaySurvey& survey) const;
  /// Returns the bytes that a survey will have counted at the end.
  std::int64_t bytes() const;
};

/// Tunes the row filters to a record before the record is estimated, so that no window is lost to
/// wrong filters.
///
/// A pass runs the pipeline's main windows and publishes nothing. The first pass begins with the
/// design, each later one with the tuning of the pass before. A pass ends with the input, or when
/// its tuning has held for kEnough windows with values, so that of a long archive only the part up
/// to its first minute of strong motion is read. The last pass is the one whose tuning held for
/// kHolds such windows, or ended where it began, or pass kMaxPasses. A tuning holds while no
/// filter's corner moves by more than kMoved, the limit beyond which the pipeline tunes anew.
class FirstPasses {
 public:
  static constexpr int kEnough = 12, kHolds = 3, kMaxPasses = 4;
  static constexpr double kMoved = 0.1;

  /// Runs the passes. progress: called with the bytes read so far; may be empty.
  FirstPasses(const Config& config, const TuningInput& input,
              const std::function<void(std::int64_t bytes)>& progress = {});

  /// Returns nullopt when the input cannot be read, shows too little motion, or self-tuning is off.
  const std::optional<estimator::Tuning>& tuning() const { return tuning_; }
  int passes() const { return passes_; }
  /// Returns false when the input could not be read; the estimation's own pass reports why.
  bool read() const { return read_; }
  /// Returns a line for the user about the passes, with the estimation's own pass counted.
  std::string note() const;

 private:
  std::optional<estimator::Tuning> tuning_;
  int passes_ = 0;
  bool read_ = false;
};

/// Returns true if the configuration enables self-tuning for an estimator that supports it.
bool can_be_tuned(const Config& config);

}  // namespace framewatch::daemon
