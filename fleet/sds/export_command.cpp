// SPDX-License-Identifier: MIT
#include "fleet/sds/export_command.h"

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/printable.h"
#include "fleet/sds/sds_archive.h"
#include "fleet/store/database.h"
#include "fleet/store/fleet_schema.h"
#include "fleet/view/building_view.h"
#include "fleet/view/rows.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kExport = "fleet export";

constexpr const char* kStretches =
    "SELECT b.name, r.request, b.network, coalesce(b.station, 'B' || lpad(b.id::text, 4, '0'))"
    " FROM raw_piece r JOIN building b ON b.id = r.building"
    " WHERE ($1 = '' OR b.name = $1) AND ($2 = '' OR r.request = $2) AND r.pieces > 0"
    " GROUP BY b.id, r.request ORDER BY b.name, min(r.came)";

/// Writes one piece of samples into the folders and prints what it did. Returns false on failure.
bool put(Database& database, const Database::Row& row, const std::string& root) {
  const std::string building = text_at(row, 0), request = text_at(row, 1);
  const auto say = [&](const std::string& text) {
    fmt::print("{} {}: {}\n", building, request, daemon::printable(text));
  };
  std::string why;
  const auto stretch = read_fetched(database, building, request, why);
  if (!stretch) {
    say(why);
    return false;
  }
  const SdsOutcome done = add_to_sds(root, stretch->miniseed, {text_at(row, 2), text_at(row, 3)});
  for (const std::string& path : done.files) fmt::print("{}\n", path);
  if (!done.problem.empty())
    say(done.problem + " (" + stretch->file + ")");
  else if (done.files.empty())
    say("is there already");
  return done.problem.empty();
}

}  // namespace

int export_command(const ExportArguments& a) {
  Database database;
  if (!database.open(a.database)) return daemon::refuse(kExport, database.error());
  if (const std::string problem = upgrade(database); !problem.empty())
    return daemon::refuse(kExport, problem);
  const auto rows = database.query(kStretches, {a.building, a.request});
  if (!rows) return daemon::refuse(kExport, database.error());
  if (rows->empty()) return daemon::refuse(kExport, "no such raw samples were fetched");
  bool all = true;
  for (const Database::Row& row : *rows) all = put(database, row, a.root) && all;
  return all ? 0 : daemon::kFailed;
}

}  // namespace framewatch::fleet
