#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/config/sections/config_problems.h"
#include "daemon/config/sections/settings.h"
#include "estimator/watch/baseline.h"

namespace framewatch::daemon {

/// The model that a configuration file describes by its design and effects, as diagnose writes it,
/// for the building of `config`. Empty with every problem when the file has any, describes another
/// building, or has no design.
std::optional<estimator::GapModel> load_gap_model_file(const Config& config,
                                                       const std::string& path,
                                                       std::vector<ConfigProblem>& problems);

/// Does the same with a text. `path` is its name in messages.
std::optional<estimator::GapModel> parse_gap_model(const Config& config, const std::string& path,
                                                   const std::string& text,
                                                   std::vector<ConfigProblem>& problems);

/// Reads the model of [gap] into the configuration if its file exists.
void load_gap_model(Config& config, std::vector<ConfigProblem>& problems);

/// File name of the segment that shows a gap, in GapSettings::store; empty when none is stored.
std::string segment_name(const Config& config, std::int64_t gap_id);

/// Baseline as a TOML file, one [[parameter]] each with name, value, std_error, unit and, when they
/// are known, temperature and values by amplitude; the same baseline gives the same bytes.
std::string baseline_text(const estimator::Baseline& baseline,
                          const estimator::ParameterTable& table);

/// `text`, extended by the parameters that `baseline` has and `written` lacks.
std::string extended_baseline_text(const std::string& text, const estimator::Baseline& written,
                                   const estimator::Baseline& baseline,
                                   const estimator::ParameterTable& table);

/// Reads one for this building. Empty optional and every problem at once when it is not valid.
std::optional<estimator::Baseline> load_baseline(const std::string& path,
                                                 const estimator::ParameterTable& table,
                                                 std::vector<ConfigProblem>& problems);

/// Reads the baseline file of [watch] into the configuration if the file exists.
void load_watch_baseline(Config& config, std::vector<ConfigProblem>& problems);

}  // namespace framewatch::daemon
