// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::test {

/// The configuration file of the two-story table, and 12 s of its virtual test: an LCM log or, if
/// the name ends in .csv, a record.
std::string table_config();
void record_table_test(const std::string& path, double duration_s = 12);

}  // namespace framewatch::test
