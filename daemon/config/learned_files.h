// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/config/sections/config_problems.h"
#include "daemon/config/sections/settings.h"
#include "estimator/watch/baseline.h"

namespace framewatch::daemon {

/// Reads the model in the design and effects of a configuration file, as diagnose writes it, for
/// the building of `config`. Returns nullopt and appends every problem if the file is invalid,
/// describes another building, or has no design.
std::optional<estimator::GapModel> load_gap_model_file(const Config& config,
                                                       const std::string& path,
                                                       std::vector<ConfigProblem>& problems);

/// Does the same with a text. `path` is its name in messages.
std::optional<estimator::GapModel> parse_gap_model(const Config& config, const std::string& path,
                                                   const std::string& text,
                                                   std::vector<ConfigProblem>& problems);

/// Reads the model of [gap] into the configuration if its file exists.
void load_gap_model(Config& config, std::vector<ConfigProblem>& problems);

/// Returns the file of the segment that shows a gap, in GapSettings::store. Empty if segments are
/// not stored.
std::string segment_name(const Config& config, std::int64_t gap_id);

/// Returns a baseline as TOML, one [[parameter]] each with name, value, std_error, unit and, if
/// known, temperature and values by amplitude. Equal baselines give equal bytes.
std::string baseline_text(const estimator::Baseline& baseline,
                          const estimator::ParameterTable& table);

/// Returns `text` with the parameters appended that `baseline` has and `written` lacks.
std::string extended_baseline_text(const std::string& text, const estimator::Baseline& written,
                                   const estimator::Baseline& baseline,
                                   const estimator::ParameterTable& table);

/// Reads a baseline for this building. Returns nullopt and appends every problem if it is invalid.
std::optional<estimator::Baseline> load_baseline(const std::string& path,
                                                 const estimator::ParameterTable& table,
                                                 std::vector<ConfigProblem>& problems);

/// Reads the baseline file of [watch] into the configuration if the file exists.
void load_watch_baseline(Config& config, std::vector<ConfigProblem>& problems);

}  // namespace framewatch::daemon
