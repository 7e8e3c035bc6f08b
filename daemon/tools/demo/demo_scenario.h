// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/config/config.h"
#include "daemon/tools/simulation/scenario.h"

namespace framewatch::daemon {

/// Gives every accelerometer of the demo a separate CANopen node on the bus of `interface`, at 500
/// kbit/s. It samples at the SYNC and sends 24 bits of 1e-5 m/s^2 and a counter.
void put_on_can(Config& config, const std::string& interface);

/// Text of the built-in scenario, configs/scenario_table_two_story.toml.
Scenario demo_scenario();
/// configs/scenario_tall_20_stories.toml.
Scenario tall_demo_scenario();

/// The building of a demo and its change.
struct DemoBuilding {
  Scenario scenario;
  std::string loses;  ///< parameter whose stories lose stiffness
  double loss_ratio;
  double forgotten_s;       ///< time after which windows and filters contain only the changed state
  std::string config_text;  ///< text of the scenario's configuration
  std::string title;        ///< title of a report
};
/// Returns the demo's building. `stories`: 2 or 20.
DemoBuilding demo_building(int stories);

/// Returns the true parameters after the loss, in the order of every story's parameters.
Eigen::VectorXd after_loss(const DemoBuilding& building);

/// Returns the true values by parameter name, SI, of groups of stories in series. `theta`:
/// parameters of every story.
std::map<std::string, double> truth_of(const Scenario& scenario, const Eigen::VectorXd& theta);

}  // namespace framewatch::daemon
