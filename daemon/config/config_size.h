// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/base/toml_document.h"
#include "daemon/config/sections/settings.h"

namespace framewatch::daemon {

/// Largest memory of a configuration, bytes: 300 stories of 3x3 bays take 1.1 GiB.
inline constexpr double kMaxConfigBytes = 1.25 * 1024 * 1024 * 1024;

/// Largest number of degrees of freedom of a simulated building: its dense matrices take seconds
/// with 640.
inline constexpr int kMaxSimulatedFreedoms = 640;

/// Returns why a building is too large to simulate, or an empty text.
std::string simulated_size_problem(const estimator::Structure& structure);

/// Appends problems of size for a configuration without other problems, before anything that large
/// is allocated. Checks the memory of the estimation, naming the key that takes the most, and the
/// building that [gap] would simulate.
void check_size(const TomlValue& document, const Config& config,
                std::vector<TextProblem>& problems);

}  // namespace framewatch::daemon
