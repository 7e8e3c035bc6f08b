#include "fleet/worker/missing_days.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "drivers/files/number_text.h"

namespace framewatch::fleet {
namespace {

using nlohmann::json;

constexpr const char* kFormat = "framewatch.inventory/1";
constexpr std::size_t kMaxDays = 400, kMaxPeriods = 16;
constexpr std::int64_t kLatest_us = INT64_MAX / 4;

std::optional<std::int64_t> count_of(const json& object, const char* name) {
  const auto found = object.find(name);
  if (found == object.end() || !found->is_number_integer()) return std::nullopt;
  return found->get<std::int64_t>();
}

std::optional<InventoryDay> day_of(const json& object) {
  if (!object.is_object()) return std::nullopt;
  const auto from_us = count_of(object, "from_us"), events = count_of(object, "events");
  const auto periods = object.find("periods");
  if (!from_us || *from_us < -kLatest_us || *from_us > kLatest_us || !events ||
      periods == object.end() || !periods->is_object() || periods->size() > kMaxPeriods)
    return std::nullopt;
  InventoryDay out{*from_us, {*events, {}}};
  for (const auto& [period, count] : periods->items()) {
    const auto period_s = drivers::parse_integer(period);
    if (!period_s || !count.is_number_integer()) return std::nullopt;
    out.counts.periods[*period_s] = count.get<std::int64_t>();
  }
  return out;
}

bool lacks(const DayCounts& stored, const DayCounts& wanted) {
  return stored.events < wanted.events ||
         std::any_of(wanted.periods.begin(), wanted.periods.end(), [&](const auto& one) {
           const auto found = stored.periods.find(one.first);
           return found == stored.periods.end() ? one.second > 0 : found->second < one.second;
         });
}

}  // namespace

std::vector<InventoryDay> inventory_days(std::string_view text) {
  const json document = json::parse(text.begin(), text.end(), nullptr, false);
  if (!document.is_object() || document.value("format", json()) != kFormat) return {};
  const auto days = document.find("days");
  if (days == document.end() || !days->is_array() || days->size() > kMaxDays) return {};
  std::vector<InventoryDay> out;
  for (const json& one : *days) {
    auto day = day_of(one);
    if (!day) return {};
    out.push_back(std::move(*day));
  }
  std::sort(out.begin(), out.end(),
            [](const InventoryDay& a, const InventoryDay& b) { return a.from_us < b.from_us; });
  return out;
}

std::optional<std::vector<std::int64_t>> missing_days(FleetStore& store,
                                                      const std::string& building) {
  const auto text = store.newest_text(building, "inventory");
  if (!text) return std::nullopt;
  std::vector<InventoryDay> days = inventory_days(*text);
  if (!days.empty()) days.pop_back();
  std::reverse(days.begin(), days.end());
  std::vector<std::int64_t> out;
  for (const InventoryDay& day : days) {
    const auto stored = store.counts(building, day.from_us, day.from_us + daemon::kDay_us);
    if (!stored) return std::nullopt;
    if (lacks(*stored, day.counts)) out.push_back(day.from_us);
  }
  return out;
}

}  // namespace framewatch::fleet
