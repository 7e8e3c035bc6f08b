// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/records/record.h"
#include "estimator/simulate/ground_motion.h"

// Files of the data folder (FRAMEWATCH_DATA), which are not part of the program.
namespace framewatch::daemon {

/// Read the paper's ground motions, El Centro 1940 NS and Hachinohe 1968 NS, from the folder
/// `ground_motions` of `data`. Return nullopt when the file is missing or damaged.
std::optional<estimator::GroundMotion> el_centro_ns(const std::string& data);
std::optional<estimator::GroundMotion> hachinohe_ns(const std::string& data);

/// A run of the measured three-story table model (docs/shaking-table.md) and its files below
/// mini_shake_table_xsens_2025/Flexible_vs_Stiff/Flexible_3_story of the data folder, one per level
/// from the ground up.
struct MeasuredRun {
  std::string name;
  std::vector<std::string> files;
};
const std::vector<MeasuredRun>& measured_runs();

/// Reads the x axes of a run's levels on their common clock, in the order of the levels and of the
/// channels of configs/mini_shake_table_xsens.toml. Returns nullopt when a file is missing or
/// damaged.
std::optional<drivers::Record> read_measured_run(const std::string& data, const MeasuredRun& run);

}  // namespace framewatch::daemon
