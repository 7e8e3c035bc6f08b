// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace framewatch::study {

/// Imports a practice case of the data folder (structure.json, record_*.csv.gz, truth.json, made
/// with another program) as a case of the study. Writes the engineer's belief as config.toml, the
/// records, and the truth in the catalog's words. Returns false and sets `error` if it is not such
/// a case.
bool import_practice(const std::string& source, const std::string& directory, std::string& error);

}  // namespace framewatch::study
