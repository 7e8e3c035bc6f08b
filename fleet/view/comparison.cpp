// SPDX-License-Identifier: MIT
#include "fleet/view/comparison.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "estimator/numeric/quantile.h"
#include "fleet/view/rows.h"

namespace framewatch::fleet {
namespace {

constexpr double kOfNormal = 1.4826;  // standard deviation over median absolute deviation
constexpr double kByChance = 0.05;

using daemon::kSecond_us;
using estimator::mean_median;

/// Kinds 2 and 3 of parameter_table_t are damping.
bool is_stiffness(std::int32_t kind) {
  return kind != 2 && kind != 3;
}

// Finds the rows of a building by the primary key. Constant limits make PostgreSQL skip other
// months. Leaves out damping, which comes last.
constexpr const char* kPeriodRows =
    "SELECT b.id, s.config, s.start_us, s.n[1:{6}], s.median[1:{6}], s.std_error[1:{6}]"
    " FROM unnest(ARRAY[{0}]::int[]) b(id) JOIN LATERAL ("
    " SELECT * FROM summary WHERE building = b.id AND period_s = {1}"
    " AND start_us BETWEEN {2} AND {3} UNION ALL"
    " SELECT * FROM summary WHERE building = b.id AND period_s = {1}"
    " AND start_us BETWEEN {4} AND {5}) s ON true";
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
  std::string name, unit;
  std::vector<float> medians[2], errors[2];
};
/// The parameters of one building in the order of their first period. places: by configuration, the
/// index of each of its parameters in `values`; -1 for damping.
struct Side {
  std::vector<Gathered> values;
  std::map<std::string, std::vector<int>> places;
  int periods[2] = {0, 0};

  int place_of(const std::string& name, const std::string& unit) {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (values[i].name == name) return static_cast<int>(i);
    values.push_back({name, unit, {}, {}});
    return static_cast<int>(values.size() - 1);
  }
};

}  // namespace

Level level_of(std::span<const float> medians, std::span<const float> std_errors) {
  if (medians.empty()) return {};
  Level out;
  out.periods = static_cast<int>(medians.size());
  out.value = mean_median({medians.begin(), medians.end()});
  std::vector<double> away;
  for (const float m : medians) away.push_back(std::abs(static_cast<double>(m) - out.value));
  double squares = 0;
  for (const float e : std_errors) squares += static_cast<double>(e) * static_cast<double>(e);
  const auto periods = static_cast<double>(medians.size());
  const double s = std::max(std::sqrt(squares / periods), kOfNormal * mean_median(std::move(away)));
  out.std_error = std::sqrt(0.5 * std::numbers::pi / periods) * s;
  return out;
}

void compare(Comparison& c) {
  c.compared = c.before.periods > 0 && c.after.periods > 0 && c.before.value > 0;
  if (!c.compared) return;
  c.ratio = c.after.value / c.before.value - 1;
  c.std_error = std::hypot(c.after.std_error / c.before.value,
                           c.after.value * c.before.std_error / (c.before.value * c.before.value));
}

double significant_errors(std::size_t comparisons) {
  const double chance = kByChance / static_cast<double>(std::max<std::size_t>(comparisons, 1));
  double low = 0, high = 40;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(middle / std::numbers::sqrt2) > chance ? low : high) = middle;
  }
  return high;
}

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

bool PeriodReader::read_names(const std::string& ids, std::size_t& stiffnesses) {
  const auto rows = database_.query_binary(fmt::format(kNames, ids));
  if (!rows) return false;
  names_.clear();
  for (const Database::Row& row : *rows) {
    Names names{list_of<std::string>(text_at(row, 2)), list_of<std::string>(text_at(row, 3)),
                list_of<std::int32_t>(text_at(row, 4))};
    if (names.unit.size() != names.name.size() || names.kind.size() != names.name.size()) continue;
    for (std::size_t i = 0; i < names.kind.size(); ++i)
      if (is_stiffness(names.kind[i])) stiffnesses = std::max(stiffnesses, i + 1);
    names_[{integer_of(text_at(row, 0)), text_at(row, 1)}] = std::move(names);
  }
  return true;
}

namespace {

/// Adds the values of a period. places: of its configuration (Side).
void gather(Side& side, const std::vector<int>& places, const Database::Row& row, int which) {
  const auto n = integers_of(*row[3]);
  const auto median = reals_of(*row[4]), error = reals_of(*row[5]);
  if (n.size() != places.size() || median.size() != n.size() || error.size() != n.size()) return;
  ++side.periods[which];
  for (std::size_t i = 0; i < n.size(); ++i) {
    if (places[i] < 0 || n[i] <= 0 || !(median[i] > 0) || !(error[i] >= 0)) continue;
    Gathered& values = side.values[static_cast<std::size_t>(places[i])];
    values.medians[which].push_back(median[i]);
    values.errors[which].push_back(error[i]);
  }
}

void compare_sides(const Side& side, ComparedBuilding& out) {
  out.before = side.periods[0];
  out.after = side.periods[1];
  for (const Gathered& g : side.values) {
    Comparison both{g.name, g.unit, level_of(g.medians[0], g.errors[0]),
                    level_of(g.medians[1], g.errors[1])};
    compare(both);
    out.stiffness.push_back(std::move(both));
  }
}

}  // namespace

bool PeriodReader::read_some(const std::vector<std::int64_t>& ids,
                             std::map<std::int64_t, ComparedBuilding>& buildings,
                             const ComparedTime& t, int least) {
  const std::string list = comma_list(ids);
  const std::int64_t length_us = t.period_s * kSecond_us;
  std::size_t stiffnesses = 0;
  if (!read_names(list, stiffnesses)) return false;
  const auto rows = database_.query_binary(fmt::format(kPeriodRows, list, t.period_s, t.from_us,
                                                       t.until_us - length_us, t.after_us,
                                                       t.to_us - length_us, stiffnesses));
  if (!rows) return false;
  std::map<std::int64_t, Side> sides;
  for (const Database::Row& row : *rows) {
    const std::int64_t id = integer_of(*row[0]);
    const auto known = names_.find({id, *row[1]});
    if (known == names_.end()) continue;
    Side& side = sides[id];
    const auto [places, is_new] = side.places.try_emplace(*row[1]);
    const Names& names = known->second;
    for (std::size_t i = 0; is_new && i < std::min(stiffnesses, names.name.size()); ++i)
      places->second.push_back(
          is_stiffness(names.kind[i]) ? side.place_of(names.name[i], names.unit[i]) : -1);
    gather(side, places->second, row, integer_of(*row[2]) >= t.after_us ? 1 : 0);
  }
  for (const auto& [id, side] : sides) {
    if (side.periods[0] < least || side.periods[1] < least) continue;
    ComparedBuilding& out = buildings.at(id);
    out.period_s = t.period_s;
    compare_sides(side, out);
  }
  return true;
}

}  // namespace framewatch::fleet
