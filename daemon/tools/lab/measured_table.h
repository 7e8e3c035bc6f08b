#pragma once

#include <optional>
#include <string>
#include <vector>

#include "drivers/records/record.h"

namespace framewatch::daemon {

/// A run of the measured three-story table model (docs/shaking-table.md) and its files below
/// mini_shake_table_xsens_2025/Flexible_vs_Stiff/Flexible_3_story of the data folder, one per level
/// from the ground up.
struct MeasuredRun {
  std::string name;
  std::vector<std::string> files;
};
const std::vector<MeasuredRun>& measured_runs();

/// The x axes of a run's levels on their common clock, in the order of the levels, as
/// configs/mini_shake_table_xsens.toml has its channels. Empty when a file is missing or damaged.
std::optional<drivers::Record> read_measured_run(const std::string& data, const MeasuredRun& run);

}  // namespace framewatch::daemon
