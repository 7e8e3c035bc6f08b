#pragma once

#include <string>

namespace framewatch::study {

/// A practice case of the data folder (structure.json, record_*.csv.gz, truth.json, made with
/// another program) as a case of the study: what the engineer believes as config.toml, the records,
/// the truth in the catalogue's words. False, and the reason, when it is none.
bool import_practice(const std::string& source, const std::string& directory, std::string& error);

}  // namespace framewatch::study
