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

/// What a motion did to the stories, computed once for every page and file that shows it.
struct DriftReport {
  std::vector<estimator::StoryDrift> drifts;  ///< from the lowest story up
  /// By story and damage state: probability of that state or a worse one; empty without
  /// [fragility], NaN where the drift is not known.
  std::vector<std::array<double, estimator::kDamageStates>> damage;
  std::optional<estimator::PlacardChoice> placard;  ///< none without [fragility]
  std::string reason;                ///< of the placard, or that no fragility is configured
  std::vector<std::string> remarks;  ///< what is to be known of the drifts, one sentence each
};

/// peak, known: of the motion, for the axes of `pipeline`, which is the configuration's. loss: a
/// lasting loss of stiffness, in words; with one the placard is restricted use at best. Empty:
/// none.
DriftReport drift_report(const Config& config, const estimator::PipelineConfig& pipeline,
                         const estimator::PeakResponse& peak,
                         const estimator::DriftKnowledge& known, const std::string& loss = "");

/// HTML: the placard with its reason, to stand first; empty without [fragility].
std::string placard_section(const DriftReport& report);
/// HTML: a table of every story's drift with its error and of its damage, and the remarks.
std::string drift_table_section(const DriftReport& report, const Config& config);

/// Members of the event report's JSON, and the whole of drifts_json(): "stories", "placard",
/// "fragility" (docs/formats.md).
void add_drifts(const DriftReport& report, const Config& config, nlohmann::ordered_json& to);
/// Schema framewatch.drifts/1.
std::string drifts_json(const DriftReport& report, const Config& config);

}  // namespace framewatch::daemon
