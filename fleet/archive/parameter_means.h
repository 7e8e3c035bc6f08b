#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

namespace framewatch::fleet {

/// Every parameter of a database with the tables of a history, over all of its shortest periods:
/// by name its unit, in how many windows it was observable, mean, standard error (root mean square
/// of the windows' own), least and largest value. Null when the database cannot be read.
nlohmann::ordered_json parameter_means(const std::string& database);

}  // namespace framewatch::fleet
