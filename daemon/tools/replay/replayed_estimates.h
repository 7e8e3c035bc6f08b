// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/tools/replay/first_passes.h"
#include "estimator/identify/estimate/estimate.h"

namespace framewatch::daemon {

/// Estimates of the main window as one array per quantity, indexed by window, or by window x
/// parameter with the parameter fastest.
struct EstimateArrays {
  std::vector<std::int64_t> start_us, end_us, sequence;
  std::vector<std::uint8_t> status;    ///< estimator::WindowStatus
  std::vector<std::int32_t> rows;      ///< sample sets in the window
  std::vector<double> residual_ratio;  ///< rms residual over rms response
  std::vector<double> value;           ///< SI; NaN if the parameter is not observable
  std::vector<double> std_error;       ///< SI, one standard deviation; NaN like value
  std::vector<std::uint8_t> reason;    ///< estimator::Observability

  void add(const estimator::WindowEstimate& estimate);
};

/// The result of replay_estimates().
struct ReplayedEstimates {
  std::vector<std::string> problems;  ///< "place: rule"; if there are any, `arrays` is empty
  std::vector<std::string> notes;     ///< damage and other things that the user should know
  EstimateArrays arrays;
};

/// Called at each event or instant with the current work, "tuning" or "replay", and the share of it
/// that is done, 0 to 1. May throw to end the replay.
using ReplayStep = std::function<void(const char* what, double share)>;

/// Estimates the whole input as `framewatch replay` does, without an output: first tunes on the
/// input unless `one_pass` is set. The estimates are those of the program, to the bit.
ReplayedEstimates replay_estimates(const Config& config, const TuningInput& input, bool one_pass,
                                   const ReplayStep& step = {});

}  // namespace framewatch::daemon
