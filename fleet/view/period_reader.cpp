#include "fleet/view/period_reader.h"

#include <optional>
#include <string_view>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "fleet/view/rows.h"

namespace framewatch::fleet {
namespace {

using daemon::kSecond_us;

/// By the kind of parameter_table_t, which 2 and 3 are of damping.
bool is_stiffness(std::int32_t kind) {
  return kind != 2 && kind != 3;
}

// A building's rows are found by the primary key; the limits are constants, so that no other month
// is looked at.
constexpr const char* kPeriodRows =
    "SELECT b.id, s.config, s.start_us, s.n, s.median, s.std_error"
    " FROM unnest(ARRAY[{0}]::int[]) b(id) JOIN LATERAL (SELECT * FROM summary WHERE building = "
    "b.id"
    " AND period_s = {1} AND ((start_us >= {2} AND start_us <= {3}) OR"
    " (start_us >= {4} AND start_us <= {5}))) s ON true";
constexpr const char* kNames =
    "SELECT building, config, to_json(name), to_json(unit), to_json(kind)"
    " FROM parameters WHERE building = ANY(ARRAY[{}]::int[])";

std::string comma_list(const std::vector<std::int64_t>& ids) {
  std::string out;
  for (const std::int64_t id : ids) out += (out.empty() ? "" : ",") + std::to_string(id);
  return out;
}

template <typename Value>
std::vector<Value> list_of(const std::string& text) {
  const auto document = nlohmann::json::parse(text, nullptr, false);
  std::vector<Value> out;
  if (document.is_array())
    for (const auto& one : document) out.push_back(one.template get<Value>());
  return out;
}

/// Values of one parameter before [0] and after [1].
struct Gathered {
  std::vector<float> medians[2], errors[2];
  std::string unit;
};
/// Of one building: parameters by name, in the order in which they came.
struct Side {
  std::vector<std::string> order;
  std::map<std::string, Gathered> values;
  int periods[2] = {0, 0};
};

}  // namespace

bool PeriodReader::read(std::map<std::int64_t, ComparedBuilding>& buildings,
                        const ComparedTime& time, int least) {
  std::vector<std::int64_t> ids;
  for (auto at = buildings.begin(); at != buildings.end();) {
    if (at->second.period_s == 0) ids.push_back(at->first);
    ++at;
    if (ids.empty() || (ids.size() < kAtOnce && at != buildings.end())) continue;
    if (!read_some(ids, buildings, time, least)) return false;
    ids.clear();
  }
  return true;
}

const PeriodReader::Names* PeriodReader::names_of(std::int64_t building,
                                                  const std::string& config) {
  const auto found = names_.find({building, config});
  return found == names_.end() ? nullptr : &found->second;
}

bool PeriodReader::read_some(const std::vector<std::int64_t>& ids,
                             std::map<std::int64_t, ComparedBuilding>& buildings,
                             const ComparedTime& t, int least) {
  const std::string list = comma_list(ids);
  const std::int64_t length_us = t.period_s * kSecond_us;
  const auto names = database_.query_binary(fmt::format(kNames, list));
  const auto rows = names ? database_.query_binary(fmt::format(kPeriodRows, list, t.period_s,
                                                               t.from_us, t.until_us - length_us,
                                                               t.after_us, t.to_us - length_us))
                          : std::nullopt;
  if (!rows) return false;
  names_.clear();
  for (const Database::Row& row : *names)
    names_[{integer_of(text_at(row, 0)), text_at(row, 1)}] = {
        list_of<std::string>(text_at(row, 2)), list_of<std::string>(text_at(row, 3)),
        list_of<std::int32_t>(text_at(row, 4))};
  std::map<std::int64_t, Side> sides;
  for (const Database::Row& row : *rows) {
    const std::int64_t id = integer_of(*row[0]);
    const Names* const known = names_of(id, *row[1]);
    const auto n = integers_of(*row[3]);
    const auto median = reals_of(*row[4]), error = reals_of(*row[5]);
    if (known == nullptr || known->name.size() != n.size() || median.size() != n.size() ||
        error.size() != n.size() || known->kind.size() != n.size() ||
        known->unit.size() != n.size())
      continue;
    Side& side = sides[id];
    const int which = integer_of(*row[2]) >= t.after_us ? 1 : 0;
    ++side.periods[which];
    for (std::size_t i = 0; i < n.size(); ++i) {
      if (!is_stiffness(known->kind[i])) continue;
      const auto [at, is_new] = side.values.try_emplace(known->name[i]);
      if (is_new) {
        side.order.push_back(known->name[i]);
        at->second.unit = known->unit[i];
      }
      if (n[i] <= 0 || !(median[i] > 0) || !(error[i] >= 0)) continue;
      at->second.medians[which].push_back(median[i]);
      at->second.errors[which].push_back(error[i]);
    }
  }
  for (auto& [id, side] : sides) {
    if (side.periods[0] < least || side.periods[1] < least) continue;
    ComparedBuilding& out = buildings.at(id);
    out.period_s = t.period_s;
    out.before = side.periods[0];
    out.after = side.periods[1];
    for (const std::string& name : side.order) {
      const Gathered& g = side.values.at(name);
      Comparison both{name, g.unit, level_of(g.medians[0], g.errors[0]),
                      level_of(g.medians[1], g.errors[1])};
      compare(both);
      out.stiffness.push_back(std::move(both));
    }
  }
  return true;
}

}  // namespace framewatch::fleet
