// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "daemon/base/toml_document.h"
#include "estimator/structure/effect.h"

namespace framewatch::daemon {

/// The [[effect]] tables of a configuration or scenario, in their order. Those with a problem are
/// left out. `structure` and `axes` must be without problems.
std::vector<estimator::Effect> read_effects(const std::vector<const TomlValue*>& tables,
                                            const estimator::Structure& structure,
                                            const std::vector<estimator::SensorAxis>& axes,
                                            std::vector<TextProblem>& problems);

/// Returns the effects as TOML. Reading it gives the same effects.
std::string effects_toml(const std::vector<estimator::Effect>& effects,
                         const estimator::Structure& structure,
                         const std::vector<estimator::SensorAxis>& axes);

}  // namespace framewatch::daemon
