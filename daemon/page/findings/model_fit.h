#pragma once

#include <cstdint>
#include <optional>

#include <framewatch/window_estimate_t.hpp>

#include "daemon/page/findings/finding.h"

namespace framewatch::daemon {

/// Whether the identified model explains the motion, from the residuals of the main windows that
/// identify something: it does not while their mean over kMean_s is over kMax. With [gap] in the
/// configuration its events say it more sharply; this needs no model of the building beside.
class ModelFit {
 public:
  static constexpr double kMax = 0.5, kAgain = 0.4, kMean_s = 10;

  void push(const window_estimate_t& estimate);

  /// Rms of what the model leaves over rms of the response; empty while it is not known.
  std::optional<double> residual() const;
  std::optional<Finding> finding() const;

 private:
  double mean_ = 0;     ///< of the squares
  double seconds_ = 0;  ///< of windows in it
  std::int64_t last_us_ = 0, since_us_ = 0;
  bool fits_ = true;
};

}  // namespace framewatch::daemon
