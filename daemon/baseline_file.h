#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/config.h"
#include "estimator/watch/baseline.h"

namespace framewatch::daemon {

/// Baseline as a TOML file, one [[parameter]] each with name, value, std_error, unit and, when it
/// is known, temperature; the same baseline gives the same bytes.
std::string baseline_text(const Baseline& baseline, const ParameterTable& table);

/// The file's text with the parameters that `baseline` has and `written` has not behind it.
std::string extended_baseline_text(const std::string& text, const Baseline& written,
                                   const Baseline& baseline, const ParameterTable& table);

/// Reads one for this building. Empty optional and every problem at once when it is not valid.
std::optional<Baseline> load_baseline(const std::string& path, const ParameterTable& table,
                                      std::vector<ConfigProblem>& problems);

}  // namespace framewatch::daemon
