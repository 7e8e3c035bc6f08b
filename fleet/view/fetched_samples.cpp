#include "fleet/view/fetched_samples.h"

#include <fmt/core.h>

#include "fleet/view/rows.h"

namespace framewatch::fleet {
namespace {

constexpr const char* kPiecesOf =
    " FROM raw_piece WHERE building = (SELECT id FROM building WHERE name = $1) AND request = $2";

}  // namespace

std::optional<FetchedSamples> read_fetched(Database& database, const std::string& building,
                                           const std::string& request, std::string& why) {
  const auto state = database.query(
      fmt::format("SELECT count(*), max(pieces), min(file){}", kPiecesOf), {building, request});
  const auto pieces =
      state ? database.query_binary(fmt::format("SELECT content{} ORDER BY piece", kPiecesOf),
                                    {building, request})
            : std::nullopt;
  if (!pieces) {
    why = database.error();
    return std::nullopt;
  }
  const std::int64_t come = integer_at(state->front(), 0), all = integer_at(state->front(), 1);
  FetchedSamples out{text_at(state->front(), 2), {}};
  for (const Database::Row& piece : *pieces)
    out.miniseed.insert(out.miniseed.end(), piece[0]->begin(), piece[0]->end());
  if (come == all && come > 0) return out;
  why = come == 0  ? "nothing of it has come"
        : all == 0 ? "there is nothing: " + std::string(out.miniseed.begin(), out.miniseed.end())
                   : fmt::format("{} of {} pieces have come", come, all);
  return std::nullopt;
}

}  // namespace framewatch::fleet
