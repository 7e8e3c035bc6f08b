// SPDX-License-Identifier: MIT
#include "fleet/serve/person_command.h"

#include <vector>

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/file_digest.h"
#include "daemon/page/web/web_socket.h"
#include "drivers/files/input_file.h"
#include "drivers/files/number_text.h"
#include "fleet/hub/users_file.h"
#include "fleet/sds/sds_archive.h"
#include "fleet/serve/people.h"
#include "fleet/store/database.h"
#include "fleet/store/fleet_schema.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kPerson = "fleet person";
constexpr const char* kDescribe = "fleet describe";

constexpr const char* kPut =
    "INSERT INTO building (name, title, place, latitude, longitude, retired, network, station)"
    " VALUES ($1, coalesce($2, ''), coalesce($3, ''), $4::double precision, $5::double precision,"
    " coalesce($6::boolean, false), coalesce($7, 'XX'), $8) ON CONFLICT (name) DO UPDATE SET"
    " title = coalesce($2, building.title), place = coalesce($3, building.place),"
    " latitude = coalesce($4::double precision, building.latitude),"
    " longitude = coalesce($5::double precision, building.longitude),"
    " retired = coalesce($6::boolean, building.retired),"
    " network = coalesce($7, building.network), station = coalesce($8, building.station)"
    " RETURNING name, title, place, latitude, longitude, retired";

SqlValue sql(const std::optional<double>& value) {
  return value ? SqlValue(drivers::format_number(*value)) : SqlValue();
}

}  // namespace

int person_command(const PersonArguments& a) {
  const auto role = role_of(a.role);
  if (!is_person_name(a.name) || !role)
    return daemon::refuse(kPerson, "a name has 1 to 64 letters, digits, '.', '_', '@' and '-'");
  People people;
  if (!drivers::is_absent(a.people))
    if (const std::string problem = people.read(a.people); !problem.empty())
      return daemon::refuse(kPerson, problem);
  const std::string token = daemon::random_token();
  if (a.remove) {
    if (!people.remove(a.name))
      return daemon::refuse(kPerson, fmt::format("{}: has no person {}", a.people, a.name));
  } else {
    people.put({a.name, *role, daemon::sha256(token)});
  }
  if (const std::string problem = people.write(a.people); !problem.empty())
    return daemon::refuse(kPerson, problem);
  if (!a.remove) fmt::print("{}\n", token);
  return 0;
}

int describe_command(const DescribeArguments& a) {
  if (const std::string rule = problem_of_building(a.building); !rule.empty())
    return daemon::refuse(kDescribe, fmt::format("'{}': a building {}", a.building, rule));
  if ((a.network && !is_network_code(*a.network)) || (a.station && !is_station_code(*a.station)))
    return daemon::refuse(kDescribe, "codes have A-Z and 0-9: a network 1 or 2, a station 1 to 5");
  Database database;
  if (!database.open(a.database)) return daemon::refuse(kDescribe, database.error());
  if (const std::string problem = upgrade(database); !problem.empty())
    return daemon::refuse(kDescribe, problem);
  const auto rows =
      database.query(kPut, {a.building, a.title, a.place, sql(a.latitude), sql(a.longitude),
                            a.retired       ? SqlValue("true")
                            : a.not_retired ? SqlValue("false")
                                            : SqlValue(),
                            a.network, a.station});
  if (!rows || rows->empty()) return daemon::refuse(kDescribe, database.error());
  const Database::Row& row = rows->front();
  fmt::print("{}: {}, {}, latitude {}, longitude {}{}\n", row[0].value_or(""), row[1].value_or(""),
             row[2].value_or(""), row[3].value_or("unknown"), row[4].value_or("unknown"),
             row[5] == SqlValue("t") ? ", retired" : "");
  return 0;
}

}  // namespace framewatch::fleet
