// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "tests/earthquake/change_score.h"
#include "tests/earthquake/demand.h"

namespace framewatch::earthquake {

struct ScoredCase {
  ChangeCase of;
  CaseScore score;
};

/// Returns the tables of docs/accuracy.md as Markdown.
std::string change_tables(const std::vector<ScoredCase>& cases);

/// Returns the requirements. most_delay_s: limit of the median time to the first announcement;
/// infinite: no limit.
std::vector<Demand> change_demands(const std::vector<ScoredCase>& cases, double most_delay_s);

}  // namespace framewatch::earthquake
