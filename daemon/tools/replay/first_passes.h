#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "daemon/tools/replay/replay_survey.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::daemon {

/// What is tuned on, and how it is read.
struct TuningInput {
  std::vector<std::string> paths;   ///< logs and record files, in order of time
  RecordFileArguments record = {};  ///< what record files do not say themselves
  bool salvage = false;             ///< damaged input is left out instead of refused
  ReplaySpan span = {};
};

/// Tunes the row filters to a record before it is estimated, so that no window of it is lost while
/// they are not right. A pass runs the pipeline's main windows, publishes nothing, and begins where
/// the one before ended, the first with the design. It ends with the input, or when the tuning has
/// held for kEnough windows with values: of an archive only the part up to its first minute of
/// strong motion is read. No further pass follows when the tuning held for kHolds such windows, or
/// ends where it began; kMaxPasses at most. A tuning holds while no filter's corner moves by more
/// than kMoved, from which on the pipeline tunes anew.
class FirstPasses {
 public:
  static constexpr int kEnough = 12, kHolds = 3, kMaxPasses = 4;
  static constexpr double kMoved = 0.1;

  /// progress: called with the bytes read so far; may be empty.
  FirstPasses(const Config& config, const TuningInput& input,
              const std::function<void(std::int64_t bytes)>& progress = {});

  /// Empty when the input cannot be read or shows too little, or when self-tuning is off.
  const std::optional<estimator::Tuning>& tuning() const { return tuning_; }
  int passes() const { return passes_; }
  /// The input could be read; otherwise reading it to estimate says why not.
  bool read() const { return read_; }
  /// What a person is told: of the passes, that of the estimation among them.
  std::string note() const;

 private:
  std::optional<estimator::Tuning> tuning_;
  int passes_ = 0;
  bool read_ = false;
};

/// Whether the configuration asks for self-tuning.
bool can_be_tuned(const Config& config);

}  // namespace framewatch::daemon
