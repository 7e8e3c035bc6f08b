#include "fleet/archive/parameter_means.h"

#include <nlohmann/json.hpp>

#include "daemon/base/sqlite_file.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kMeans =
    "SELECT name, unit, sum(observable), sum(observable * mean) / sum(observable),"
    " sqrt(sum(observable * std_error * std_error) / sum(observable)), min(min), max(max)"
    " FROM summary JOIN parameter ON parameter.id = parameter"
    " WHERE period_s = (SELECT min(period_s) FROM period) GROUP BY parameter ORDER BY parameter";

}  // namespace

nlohmann::ordered_json parameter_means(const std::string& database) {
  daemon::SqliteFile file;
  if (!file.open_to_read(database)) return nullptr;
  daemon::SqliteStatement all = file.prepare(kMeans);
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  while (all.row())
    out[all.text(0)] = {{"unit", all.text(1)},   {"observable", all.integer(2)},
                        {"mean", all.number(3)}, {"std_error", all.number(4)},
                        {"min", all.number(5)},  {"max", all.number(6)}};
  return file.failed() ? nlohmann::ordered_json() : out;
}

}  // namespace framewatch::fleet
