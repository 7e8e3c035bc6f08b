#pragma once

#include <map>
#include <string>

#include <Eigen/Core>

#include "daemon/simulation/scenario.h"

namespace framewatch::daemon {

/// The built-in scenario, configs/scenario_table_two_story.toml.
Scenario demo_scenario();

/// Stiffness and damping by parameter name, SI. theta: in the order of the scenario's parameter
/// table.
std::map<std::string, double> truth_of(const Scenario& scenario, const Eigen::VectorXd& theta);

}  // namespace framewatch::daemon
