#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/base/workers.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {

/// One way to identify, over the windows of one stage of a test: Figure 10 of the paper.
struct IdentifiedWindows {
  std::string method;
  /// [parameter][window], SI; NaN where nothing was published.
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

/// The two-story table of configs/scenario_table_two_story.toml, shaken at 30 degrees by El Centro
/// (scaled to 2 m/s^2; when `data` has it) or the scenario's motion until 20 s, then left alone.
TableTest virtual_table_test(const std::string& data, const Workers& workers);

/// The Northridge run of the measured three-story table, plane, 1 kg floors; empty without the
/// data.
std::optional<TableTest> measured_table_test(const std::string& data, const Workers& workers);

}  // namespace framewatch::daemon
