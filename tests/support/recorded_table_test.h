// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::test {

/// Configuration file of the two-story table, and 12 s of its virtual test as an LCM log or, when
/// the name ends in .csv, a record.
std::string table_config();
void record_table_test(const std::string& path, double duration_s = 12);

}  // namespace framewatch::test
