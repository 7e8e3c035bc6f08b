#include "fleet/uplink/inventory.h"

#include <map>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/utc_time.h"

namespace framewatch::fleet {
namespace {

using daemon::kDay_us;
using daemon::SqliteStatement;

constexpr std::int64_t kDays = 30;
constexpr const char* kFormat = "framewatch.inventory/1";

struct Day {
  std::int64_t events = 0;
  std::map<std::int64_t, std::int64_t> periods;  ///< count by length, s
};

}  // namespace

std::string inventory(daemon::SqliteFile& history, std::int64_t newest_us, std::int64_t least_s) {
  const std::int64_t to = newest_us / kDay_us + 1, from = to - kDays;
  std::map<std::int64_t, Day> days;  // by number since 1970
  SqliteStatement events = history.prepare(
      "SELECT time_us / ?, count(*) FROM event WHERE time_us >= ? AND time_us < ? GROUP BY 1");
  events.bind(1, kDay_us).bind(2, from * kDay_us).bind(3, to * kDay_us);
  while (events.row()) days[events.integer(0)].events = events.integer(1);
  SqliteStatement periods = history.prepare(
      "SELECT start_us / ?, period_s, count(*) FROM period WHERE start_us >= ? AND start_us < ?"
      " AND period_s >= ? AND start_us + period_s * 1000000 <= ? GROUP BY 1, 2");
  periods.bind(1, kDay_us).bind(2, from * kDay_us).bind(3, to * kDay_us).bind(4, least_s);
  periods.bind(5, newest_us);
  while (periods.row()) days[periods.integer(0)].periods[periods.integer(1)] = periods.integer(2);
  if (history.failed()) return {};
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [number, day] : days) {
    nlohmann::json counts = nlohmann::json::object();
    for (const auto& [period_s, count] : day.periods) counts[fmt::format("{}", period_s)] = count;
    list.push_back({{"day", daemon::utc_text(number * kDay_us).substr(0, 10)},
                    {"from_us", number * kDay_us},
                    {"events", day.events},
                    {"periods", counts}});
  }
  return nlohmann::json{{"format", kFormat}, {"days", list}}.dump();
}

}  // namespace framewatch::fleet
