// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "daemon/tools/simulation/simulation.h"
#include "estimator/structure/effect.h"

namespace framewatch::daemon {

/// Returns {"kind": frame | panel | node | floor | base | channel | building} with those of
/// "direction", "story", "frame", "panel", "node", "to_story", "channel" and "with_channel" that
/// apply.
nlohmann::ordered_json location_json(const estimator::EffectPlace& place,
                                     const estimator::Structure& structure,
                                     const std::vector<estimator::SensorAxis>& axes);

/// Returns {"k3_npm3": {"value": 1e7, "unit": "N/m^3"}, ...}.
nlohmann::ordered_json parameters_json(const estimator::Effect& effect);

/// Returns the truth of a scenario as JSON (docs/formats.md): the first effect under "hidden", all
/// effects under "effects", the true stiffness, damping and masses, and the sensors' faults.
std::string truth_json(const Scenario& scenario);

}  // namespace framewatch::daemon
