// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/base/workers.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {

/// Values of one method over the windows of one stage of a test: Figure 10 of the paper.
struct IdentifiedWindows {
  std::string method;
  /// [parameter][window], SI; NaN: not published.
  std::vector<std::vector<double>> values;
};

struct TableStage {
  std::string name;  ///< forced vibration, free vibration
  std::vector<IdentifiedWindows> methods;
};

/// A shaking-table test as the paper evaluates it: 500 windows of 5 s, one sample apart.
struct TableTest {
  std::string motion;
  std::vector<estimator::Parameter> parameters;
  std::vector<double> reference;  ///< truth, SI; NaN: not known
  std::vector<TableStage> stages;
};

/// Shakes the two-story table of configs/scenario_table_two_story.toml at 30 degrees until 20 s,
/// then leaves it alone. The motion is El Centro, scaled to 2 m/s^2, if `data` has it, otherwise
/// the scenario's.
TableTest virtual_table_test(const std::string& data, const Workers& workers);

/// Evaluates the Northridge run of the measured three-story table, plane, with 1 kg floors. Returns
/// nullopt without the data.
std::optional<TableTest> measured_table_test(const std::string& data, const Workers& workers);

}  // namespace framewatch::daemon
