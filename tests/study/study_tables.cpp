// SPDX-License-Identifier: MIT
#include <algorithm>
#include <functional>
#include <iterator>
#include <map>

#include <fmt/core.h>

#include "estimator/numeric/quantile.h"
#include "tests/study/study_score.h"

namespace framewatch::study {
namespace {

using Group = std::vector<const Outcome*>;

std::string percent(int part, int whole) {
  return whole > 0 ? fmt::format("{} of {} ({:.1f} %)", part, whole, 100.0 * part / whole) : "-";
}

int count(const Group& group, const std::function<bool(const Outcome&)>& holds) {
  return static_cast<int>(
      std::count_if(group.begin(), group.end(), [&](const Outcome* o) { return holds(*o); }));
}

std::string median(std::vector<double> values, const char* unit = "") {
  if (values.empty()) return "-";
  return fmt::format("{:.1f}{}", 100 * estimator::upper_median(values), unit);
}

std::string removed(const Group& group) {
  std::vector<double> values;
  for (const Outcome* o : group)
    if (const auto share = o->removed()) values.push_back(*share);
  return median(values, " %");
}

std::string errors(const Group& group) {
  std::vector<double> values;
  for (const Outcome* o : group)
    values.insert(values.end(), o->parameter_errors.begin(), o->parameter_errors.end());
  return median(values, " %");
}

std::map<std::string, Group> grouped(const std::vector<Outcome>& outcomes,
                                     const std::function<std::string(const Outcome&)>& key) {
  std::map<std::string, Group> out;
  for (const Outcome& o : outcomes) out[key(o)].push_back(&o);
  return out;
}

std::vector<Outcome> selected(const std::vector<Outcome>& outcomes,
                              const std::function<bool(const Outcome&)>& holds) {
  std::vector<Outcome> out;
  std::copy_if(outcomes.begin(), outcomes.end(), std::back_inserter(out), holds);
  return out;
}

void add_summary(const std::vector<Outcome>& outcomes, std::string& out) {
  out +=
      "| group | building | cases | name and place | place | abstained | no wrong name | "
      "confidently wrong | "
      "`adequate` | excess removed, median | parameters, median error |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
  const auto rows =
      grouped(outcomes, [](const Outcome& o) { return o.group + " | " + o.building; });
  for (const auto& [key, group] : rows) {
    const int all = static_cast<int>(group.size());
    out += fmt::format(
        "| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |\n", key, all,
        percent(count(group, [](const Outcome& o) { return o.truths > 0 && o.all_right(); }), all),
        percent(count(group,
                      [](const Outcome& o) { return o.truths > 0 && o.places_right == o.truths; }),
                all),
        percent(count(group, [](const Outcome& o) { return o.abstained(); }), all),
        percent(count(group, [](const Outcome& o) { return o.no_wrong_name(); }), all),
        percent(count(group, [](const Outcome& o) { return o.confidently_wrong; }), all),
        percent(count(group, [](const Outcome& o) { return o.verdict == "adequate"; }), all),
        removed(group), errors(group));
  }
}

void add_confusion(const std::vector<Outcome>& outcomes, std::string& out) {
  out +=
      "\n| hidden | cases | right | place right | named instead, or first of several |\n"
      "| --- | --- | --- | --- | --- |\n";
  const std::vector<Outcome> looked_for =
      selected(outcomes, [](const Outcome& o) { return o.group != kTakenOut; });
  const auto rows = grouped(looked_for, [](const Outcome& o) { return o.hidden; });
  for (const auto& [hidden, group] : rows) {
    std::map<std::string, int> instead;
    for (const Outcome* o : group)
      if (!o->all_right() || o->truths == 0)
        ++instead[o->named.empty() ? o->verdict : o->named.front()];
    std::string list;
    for (const auto& [name, times] : instead)
      list += fmt::format("{}{} {}", list.empty() ? "" : ", ", name, times);
    const int all = static_cast<int>(group.size());
    out += fmt::format(
        "| {} | {} | {} | {} | {} |\n", hidden, all,
        count(group, [](const Outcome& o) { return o.truths > 0 && o.all_right(); }),
        count(group, [](const Outcome& o) { return o.truths > 0 && o.places_right == o.truths; }),
        list);
  }
}

void add_by_noise(const std::vector<Outcome>& outcomes, std::string& out) {
  out += "\n| noise | cases | right | excess removed, median |\n| --- | --- | --- | --- |\n";
  const std::vector<Outcome> hidden =
      selected(outcomes, [](const Outcome& o) { return o.group == "catalogue"; });
  const auto rows =
      grouped(hidden, [](const Outcome& o) { return fmt::format("{:g} %", 100 * o.noise_ratio); });
  for (const auto& [noise, group] : rows)
    out +=
        fmt::format("| {} | {} | {} | {} |\n", noise, group.size(),
                    count(group, [](const Outcome& o) { return o.all_right(); }), removed(group));
}

}  // namespace

std::string tables(const std::vector<Outcome>& outcomes) {
  std::string out;
  add_summary(outcomes, out);
  add_confusion(outcomes, out);
  add_by_noise(outcomes, out);
  out += "\n| asked | | measured | |\n| --- | --- | --- | --- |\n";
  for (const Bound& b : bounds_of(outcomes))
    out += fmt::format("| {} | {} | {} | {} |\n", b.what, b.asked, b.measured,
                       b.holds ? "yes" : "**no**");
  return out;
}

}  // namespace framewatch::study
