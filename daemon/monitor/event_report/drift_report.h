// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "daemon/config/config.h"
#include "estimator/shaking/placard.h"
#include "estimator/shaking/story_drift.h"

namespace framewatch::daemon {

/// Drift and damage of the stories in one motion, computed once for all pages and files that show
/// them.
struct DriftReport {
  std::vector<estimator::StoryDrift> drifts;  ///< by story, from the lowest one up
  /// By story and damage state, the probability of that state or a worse one. Empty without
  /// [fragility]; NaN if the drift is not known.
  std::vector<std::array<double, estimator::kDamageStates>> damage;
  std::optional<estimator::PlacardChoice> placard;  ///< empty without [fragility]
  std::string reason;                ///< for the placard, or that no fragility is configured
  std::vector<std::string> remarks;  ///< notes for the reader of the drifts, one sentence each
};

/// Computes the drifts from the peak response of the motion and from what is known of the building,
/// both for the axes of `pipeline`, which belongs to `config`. `loss` is a lasting loss of
/// stiffness in words (empty: none); it makes the placard restricted use at best.
DriftReport drift_report(const Config& config, const estimator::PipelineConfig& pipeline,
                         const estimator::PeakResponse& peak,
                         const estimator::DriftKnowledge& known, const std::string& loss = "");

/// Returns HTML for the top of a page: the placard and its reason. Empty without [fragility].
std::string placard_section(const DriftReport& report);
/// Returns HTML: a table with the drift, its error and the damage of every story, and the remarks.
std::string drift_table_section(const DriftReport& report, const Config& config);

/// Adds "stories", "placard", "fragility" (docs/formats.md) to a JSON object, for event reports and
/// for drifts_json().
void add_drifts(const DriftReport& report, const Config& config, nlohmann::ordered_json& to);
/// Returns the drifts as JSON, schema framewatch.drifts/1.
std::string drifts_json(const DriftReport& report, const Config& config);

}  // namespace framewatch::daemon
