#pragma once

#include <string>

#include "estimator/shaking/shaking.h"

namespace framewatch::daemon {

/// [event_report]: what is written after strong motion, docs/operate.md.
struct EventReportSettings {
  std::string directory;
  estimator::ShakingOptions options;
  /// Of the story height, and of the stiffness before: from here on yellow, or red.
  double yellow_drift_ratio = 0.005, red_drift_ratio = 0.015;
  double yellow_loss_ratio = 0.05, red_loss_ratio = 0.2;
  int most_reports = 500;  ///< older ones are removed
};

}  // namespace framewatch::daemon
