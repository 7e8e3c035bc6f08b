#pragma once

#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "estimator/structure/effect.h"

namespace framewatch::daemon {

/// {"kind": frame | panel | node | floor | base | channel | building, and "direction", "story",
/// "frame", "panel", "node", "to_story", "channel", "with_channel" as they apply}.
nlohmann::ordered_json location_json(const estimator::EffectPlace& place,
                                     const estimator::Structure& structure,
                                     const std::vector<estimator::SensorAxis>& axes);

/// {"k3_npm3": {"value": 1e7, "unit": "N/m^3"}, ...}.
nlohmann::ordered_json parameters_json(const estimator::Effect& effect);

}  // namespace framewatch::daemon
