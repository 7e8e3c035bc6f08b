#pragma once

#include <string>
#include <vector>

#include "daemon/base/toml_document.h"
#include "daemon/config/sections/settings.h"

namespace framewatch::daemon {

/// Most memory that a configuration may ask for, bytes: 300 stories of 3x3 bays take 1.1 GiB.
inline constexpr double kMaxConfigBytes = 1.25 * 1024 * 1024 * 1024;

/// Most degrees of freedom of a building that is simulated: of its dense matrices 640 of them take
/// seconds.
inline constexpr int kMaxSimulatedFreedoms = 640;

/// Why a building is too large to be simulated; empty when it is not.
std::string simulated_size_problem(const estimator::Structure& structure);

/// Appends problems of size for a configuration without other problems, before anything that large
/// is allocated. Checks the memory of the estimation, naming the key that takes the most, and the
/// building that [gap] would simulate.
void check_size(const TomlValue& document, const Config& config,
                std::vector<TextProblem>& problems);

}  // namespace framewatch::daemon
