#include "fleet/sds/export_command.h"

#include <fmt/core.h>

#include "daemon/base/exit_code.h"
#include "daemon/base/printable.h"
#include "fleet/sds/sds_archive.h"
#include "fleet/store/database.h"
#include "fleet/store/fleet_schema.h"
#include "fleet/view/rows.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kExport = "fleet export";

constexpr const char* kStretches =
    "SELECT b.name, r.request, count(*), max(r.pieces), min(r.file), b.network,"
    " coalesce(b.station, 'B' || lpad(b.id::text, 4, '0')), b.id FROM raw_piece r JOIN building b"
    " ON b.id = r.building WHERE ($1 = '' OR b.name = $1) AND ($2 = '' OR r.request = $2)"
    " GROUP BY b.id, r.request ORDER BY b.name, min(r.came)";
constexpr const char* kPieces =
    "SELECT content FROM raw_piece WHERE building = $1 AND request = $2 ORDER BY piece";

/// Puts one stretch into the folders, and says so. False: it could not be.
bool put(Database& database, const Database::Row& row, const std::string& root) {
  const std::string what = fmt::format("{} {}", text_at(row, 0), text_at(row, 1));
  const std::string file = text_at(row, 4);
  const auto say = [&](const std::string& text) {
    fmt::print("{}: {}\n", what, daemon::printable(text));
  };
  if (integer_at(row, 2) != integer_at(row, 3)) {
    say(fmt::format("{} of {} pieces have come", integer_at(row, 2), integer_at(row, 3)));
    return false;
  }
  const auto pieces = database.query_binary(kPieces, {row[7], row[1]});
  if (!pieces) {
    say(database.error());
    return false;
  }
  Bytes all;
  for (const Database::Row& piece : *pieces)
    all.insert(all.end(), piece[0]->begin(), piece[0]->end());
  const SdsOutcome done = add_to_sds(root, all, {text_at(row, 5), text_at(row, 6)});
  for (const std::string& path : done.files) fmt::print("{}\n", path);
  if (!done.problem.empty())
    say(done.problem + " (" + file + ")");
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
  if (rows->empty()) return daemon::refuse(kExport, "no raw samples of this were fetched");
  bool all = true;
  for (const Database::Row& row : *rows) all = put(database, row, a.root) && all;
  return all ? 0 : daemon::kFailed;
}

}  // namespace framewatch::fleet
