// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/tools/commands/layout_warnings.h"

namespace framewatch::daemon {

/// Identifiability of a floor panel under ground motion, from the design.
struct PanelOutlook {
  std::string parameter;  ///< Gk_2_x1y1
  double shear_ratio;     ///< largest shear deformation over the frames' largest
};

/// Properties of a valid configuration before the first sample.
struct CheckReport {
  Config config;
  std::vector<std::string> parameters;
  int window_rows = 0;
  int hop_rows = 0;
  std::vector<double> design_hz;  ///< natural frequencies, ascending; empty without a design
  std::vector<PanelOutlook> panels;
  /// Memory of the estimator, allocated when it starts. 0 if the C library does not report it.
  std::size_t memory_bytes = 0;
  std::optional<LayoutOutlook> layout;  ///< set for a building with sensors on some floors
  std::vector<std::string> warnings;
};

/// Reports on a valid configuration. `advise`: largest number of places for further sensors.
CheckReport make_check_report(const Config& config, int advise = 0);

/// Returns several lines for people, without the warnings.
std::string to_text(const CheckReport& report);
/// Returns JSON of schema framewatch.check/1. `report` is empty if there are problems.
std::string to_json(const std::string& path, const std::optional<CheckReport>& report,
                    const std::vector<ConfigProblem>& problems);

}  // namespace framewatch::daemon
