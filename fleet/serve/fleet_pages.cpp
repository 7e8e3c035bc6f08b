#include "fleet/serve/fleet_pages.h"

#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "daemon/base/file_digest.h"
#include "daemon/base/printable.h"
#include "daemon/base/process.h"
#include "drivers/files/number_text.h"
#include "fleet/message/subject.h"
#include "fleet/serve/journal.h"
#include "fleet/view/building_view.h"
#include "fleet/view/earthquake_view.h"
#include "fleet/view/fetched_samples.h"
#include "fleet/view/overview.h"
#include "fleet/view/series.h"

namespace framewatch::fleet {
namespace {

using nlohmann::json;

constexpr const char* kJson = "application/json";
constexpr std::size_t kVersionDigits = 16, kLongestParameter = 64;
constexpr int kMaxDays = 3660;
constexpr std::int64_t kLatest_us = INT64_MAX / 4;

PageAnswer refuse(unsigned code, const std::string& why) {
  return {code, json{{"problem", why}}.dump(-1, ' ', true, json::error_handler_t::replace), kJson};
}

/// An answer of a view: 503 when the database said nothing, 404 when nothing is there.
PageAnswer view(std::string text) {
  const unsigned code = text == R"({"problem":"no such building"})" ? 404
                        : text.starts_with(R"({"problem")")         ? 503
                                                                    : 200;
  return {code, std::move(text), kJson};
}

std::optional<std::int64_t> time_of(const PageRequest& r, const std::string& name) {
  const auto value = drivers::parse_integer(r.argument(name));
  if (!value || *value < -kLatest_us || *value > kLatest_us) return std::nullopt;
  return value;
}

bool is_building_or_none(const std::string& name) {
  return name.empty() || is_building_name(name);
}

}  // namespace

std::string PageRequest::argument(const std::string& name) const {
  const auto found = arguments.find(name);
  return found == arguments.end() ? "" : found->second;
}

FleetPages::FleetPages(std::string database, Give give)
    : pool_(std::move(database)), give_(std::move(give)) {}

PageAnswer FleetPages::answer(const PageRequest& r) {
  if (r.path == "/command") return command(r);
  if (r.path == "/me.json") return me(r);
  if (r.path == "/overview.json") return overview(r);
  if (r.path == "/building.json") return building(r);
  if (r.path == "/series.json") return series(r);
  if (r.path == "/earthquake.json") return earthquake(r);
  if (r.path == "/raw.mseed") return raw(r);
  const auto lent = pool_.lend();
  if (r.path == "/earthquakes.json") {
    const auto days = drivers::parse_integer(r.argument("days"));
    if (!days || *days < 1 || *days > kMaxDays)
      return refuse(400, fmt::format("days must be 1 to {}", kMaxDays));
    return view(earthquakes_json(*lent, static_cast<int>(*days)));
  }
  if (r.path == "/journal.json") {
    if (!is_building_or_none(r.argument("name"))) return refuse(400, "name is none of a building");
    return view(journal_json(*lent, r.argument("name")));
  }
  return refuse(404, "not here");
}

PageAnswer FleetPages::me(const PageRequest& r) const {
  return {200,
          json{{"who", r.who}, {"role", role_word(r.role)}, {"hub", give_ != nullptr}}.dump(
              -1, ' ', true, json::error_handler_t::replace),
          kJson};
}

/// 204 to who has this version already. What changes all the time is no part of a version.
PageAnswer FleetPages::overview(const PageRequest& r) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::int64_t now_us = daemon::steady_clock_us();
  if (overview_.empty() || now_us - overview_us_ > kFresh_us) {
    const auto lent = pool_.lend();
    const Overview read = read_overview(*lent);
    if (!read.problem.empty()) return refuse(503, read.problem);
    overview_ = overview_json(read);
    overview_us_ = daemon::steady_clock_us();
    json same = json::parse(overview_);
    same.erase("now_us");
    same.erase("heard_us");
    version_ = daemon::sha256(same.dump()).substr(0, kVersionDigits);
    overview_.insert(1, fmt::format(R"("version":"{}",)", version_));
  }
  if (r.argument("version") == version_) return {204, "", kJson};
  return {200, overview_, kJson};
}

PageAnswer FleetPages::building(const PageRequest& r) {
  if (!is_building_name(r.argument("name"))) return refuse(400, "name is none of a building");
  const auto lent = pool_.lend();
  return view(building_json(*lent, r.argument("name")));
}

PageAnswer FleetPages::series(const PageRequest& r) {
  const auto from = time_of(r, "from_us"), to = time_of(r, "to_us");
  const std::string parameter = r.argument("parameter"), period = r.argument("period_s");
  if (!is_building_name(r.argument("name"))) return refuse(400, "name is none of a building");
  if (parameter.empty() || parameter.size() > kLongestParameter)
    return refuse(400, "parameter must have 1 to 64 characters");
  if (!from || !to || *from >= *to)
    return refuse(400, "from_us and to_us must be times in us since 1970, in this order");
  if (!period.empty() && period != "60" && period != "600" && period != "3600")
    return refuse(400, "period_s must be 60, 600 or 3600");
  const auto lent = pool_.lend();
  return view(series_json(*lent, {r.argument("name"), parameter, *from, *to,
                                  static_cast<int>(drivers::parse_integer(period).value_or(0))}));
}

PageAnswer FleetPages::earthquake(const PageRequest& r) {
  const auto time = time_of(r, "time_us");
  if (!time) return refuse(400, "time_us must be a time in us since 1970");
  if (!is_building_or_none(r.argument("name"))) return refuse(400, "name is none of a building");
  const auto lent = pool_.lend();
  return view(earthquake_json(*lent, {*time, r.argument("name")}));
}

PageAnswer FleetPages::raw(const PageRequest& r) {
  if (!is_building_name(r.argument("name"))) return refuse(400, "name is none of a building");
  const auto lent = pool_.lend();
  std::string why;
  const auto stretch = read_fetched(*lent, r.argument("name"), r.argument("request"), why);
  if (!stretch) return refuse(why == lent->error() ? 503 : 404, why);
  return {200, {stretch->miniseed.begin(), stretch->miniseed.end()}, "application/octet-stream"};
}

PageAnswer FleetPages::command(const PageRequest& r) {
  const std::string building = r.argument("building");
  CommandOrder order{
      fmt::format("page-{}", daemon::random_id()), r.who, r.argument("verb"), {}, {}};
  if (r.role != Role::operator_) {
    daemon::log(daemon::LogLevel::warning,
                daemon::printable(fmt::format("{}, a viewer, asked for the command {} to {}", r.who,
                                              order.verb.substr(0, 32), building.substr(0, 32))));
    return refuse(403, "only operators give commands");
  }
  if (!give_) return refuse(409, "this page was begun without a hub");
  if (building != "all" && !is_building_name(building))
    return refuse(400, "building must be the name of one, or all");
  std::string why;
  const auto content =
      command_content({order.verb, r.argument("from_us"), r.argument("to_us"),
                       r.argument("channels"), r.argument("id"), r.argument("comment")},
                      why);
  if (!content) return refuse(400, why);
  if (building == "all" && (order.verb == "acknowledge" || order.verb == "raw"))
    return refuse(400, order.verb + " is for one building");
  order.content = *content;
  const auto lent = pool_.lend();
  if (!note_order(*lent, building, order, why))
    return refuse(why == "no such building" ? 404 : 503, why);
  const std::string request = order.request;
  const std::size_t buildings = order.targets.size();
  daemon::log(daemon::LogLevel::notice,
              fmt::format("{}: {} to {} buildings, {}", r.who, order.verb, buildings, request));
  std::vector<CommandOrder::Target> targets = order.targets;
  if (!give_(std::move(order))) {
    for (const CommandOrder::Target& target : targets)
      (void)note_result(*lent, {request, target.id, false, "too many commands at once"});
    return refuse(503, "too many commands at once");
  }
  return {202, json{{"request", request}, {"buildings", buildings}}.dump(), kJson};
}

void FleetPages::note(const CommandResult& result) {
  const auto lent = pool_.lend();
  if (!note_result(*lent, result))
    failures_(daemon::steady_clock_us(), fmt::format("the answer to {} is not in the journal: {}",
                                                     result.request, lent->error()));
}

}  // namespace framewatch::fleet
