#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/config/sections/config_problems.h"
#include "daemon/config/sections/settings.h"
#include "estimator/watch/baseline.h"

namespace framewatch::daemon {

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
