// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

#include "daemon/tools/lab/study_buildings.h"
#include "estimator/simulate/ground_motion.h"

namespace framewatch::test {

using daemon::full_sensor_axes;
using daemon::table1;
using daemon::table1_theta;
using daemon::table2;
using daemon::table2_theta;

/// Returns the folder of the records; empty if it does not exist.
std::optional<estimator::GroundMotion> el_centro_ns();
std::optional<estimator::GroundMotion> hachinohe_ns();

}  // namespace framewatch::test
