// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "tests/earthquake/demand.h"
#include "tests/earthquake/interruption_case.h"

namespace framewatch::earthquake {

/// Returns the tables of docs/accuracy.md as Markdown. Results are in the order of the cases.
std::string interruption_tables(const std::vector<InterruptionCase>& cases,
                                const std::vector<InterruptionResult>& results);

/// Returns the requirements.
std::vector<Demand> interruption_demands(const std::vector<InterruptionCase>& cases,
                                         const std::vector<InterruptionResult>& results);

}  // namespace framewatch::earthquake
