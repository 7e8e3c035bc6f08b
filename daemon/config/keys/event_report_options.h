// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "estimator/shaking/placard.h"
#include "estimator/shaking/shaking_watch.h"

namespace framewatch::daemon {

/// [event_report]: reports after strong motion, docs/operate.md.
struct EventReportSettings {
  std::string directory;
  estimator::ShakingOptions options;
  /// Limits from which the report is yellow or red: drift relative to the story height, loss
  /// relative to the earlier stiffness.
  double yellow_drift_ratio = 0.005, red_drift_ratio = 0.015;
  double yellow_loss_ratio = 0.05, red_loss_ratio = 0.2;
  int most_reports = 500;  ///< older ones are removed
};

enum class DesignLevel { high, moderate, low, pre };

/// story uses limits of a single story's drift. height uses HAZUS' lower limits of the average
/// drift of mid-rise and high-rise buildings, by the number of stories.
enum class DriftLimits { story, height };

/// [fragility]: probable damage of a story by its peak drift, docs/operate.md.
struct FragilitySettings {
  std::string type;  ///< HAZUS' building type, "C1" or "C1M"; empty: every median is given
  DesignLevel design_level = DesignLevel::moderate;
  DriftLimits drift_limits = DriftLimits::story;
  estimator::PlacardRules rules;
  /// Follows from all keys: the fragility of every story, and its source in words.
  std::vector<estimator::Fragility> by_story = {};
  std::string source = {};
};

}  // namespace framewatch::daemon
