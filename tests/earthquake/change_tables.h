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

/// The tables of docs/accuracy.md, Markdown.
std::string change_tables(const std::vector<ScoredCase>& cases);

/// What must be reached. most_delay_s: of the median time to the first announcement; infinite:
/// nothing is asked.
std::vector<Demand> change_demands(const std::vector<ScoredCase>& cases, double most_delay_s);

}  // namespace framewatch::earthquake
