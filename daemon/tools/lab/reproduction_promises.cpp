#include <cmath>

#include <fmt/core.h>

#include "daemon/base/numbers.h"
#include "daemon/tools/lab/reproduction.h"

namespace framewatch::daemon {
namespace {

constexpr const char* kJudgedKinds[] = {"k", "G", "c"};
constexpr double kMinCoverage = 0.90, kMaxCoverage = 0.98;
constexpr double kMaxWrong = 0.05;
constexpr double kMinHeld = 0.85;
constexpr double kMaxChangeByBias = 1e-4;
/// Fewer published values say nothing about the share of intervals that hold.
constexpr int kFewestToJudge = 200;

void judge_coverage(const AccuracyRow& row, Method method, const std::string& suffix,
                    std::vector<Promise>& out) {
  for (int kind = 0; kind < 3; ++kind) {
    const ErrorStatistics& s = row.of(method, kind);
    if (s.published < kFewestToJudge) continue;
    const double share = s.coverage_ratio();
    out.push_back({fmt::format("{}{}: 95 % intervals of {} hold in 90 to 98 %", row.name, suffix,
                               kJudgedKinds[kind]),
                   percent_1(share), share >= kMinCoverage && share <= kMaxCoverage});
  }
}

void judge_row(const AccuracyRow& row, std::vector<Promise>& out) {
  for (const AccuracyCase& c : accuracy_cases()) {
    if (c.name != row.name) continue;
    for (int kind = 0; kind < 3; ++kind) {
      const double limit = c.limit[static_cast<std::size_t>(kind)];
      const double found = row.of(Method::matched, kind).quantile(0.5);
      out.push_back({fmt::format("{}: median error of {} at most {}", row.name, kJudgedKinds[kind],
                                 percent(limit)),
                     percent(found), found <= limit});
    }
    if (c.bound_limited) {
      const double ratio = row.of(Method::matched, 0).quantile(0.5) / row.least_median(0);
      out.push_back({fmt::format("{}: k within {} times the bound", row.name, kMaxOverBound),
                     fmt::format("{:.2f}", ratio), ratio <= kMaxOverBound});
    }
  }
  judge_coverage(row, Method::matched, "", out);
  judge_coverage(row, Method::matched_unaware, ", noise not configured", out);
}

void judge(const Robustness& r, std::vector<Promise>& out) {
  for (const ExcitationSweep& sweep : r.sweeps)
    out.push_back({fmt::format("{}: published k wrong by more than 5 % from 0.3 % to 3000 % noise "
                               "at most {}",
                               sweep.name, percent(kMaxWrong)),
                   percent_1(sweep.wrong_ratio(0)), sweep.wrong_ratio(0) <= kMaxWrong});
  for (const Silence& s : r.silences)
    out.push_back({fmt::format("{}{}: nothing published in {:g} h of sensor noise", s.name,
                               s.noise_configured ? "" : ", noise not configured", s.hours),
                   fmt::format("{} of {} windows", s.published, s.windows),
                   s.published == 0 && s.windows > 0});
  out.push_back({"Table 1: a bias of 0.05 m/s^2 with a thermal ramp changes k by less than 1e-4",
                 fmt::format("{:.1e}", r.change_by_bias), r.change_by_bias < kMaxChangeByBias});
  if (r.random_buildings) judge_row(*r.random_buildings, out);
}

void judge(const FewSensorsRow& row, std::vector<Promise>& out) {
  if (!(row.most_k > 0)) return;
  const double k = row.errors.stiffness.quantile(0.5), c = row.errors.damping.quantile(0.5);
  out.push_back({fmt::format("{}: median error of k at most {}", row.name, percent(row.most_k)),
                 percent(k), k <= row.most_k});
  out.push_back({fmt::format("{}: median error of c at most {}", row.name, percent(row.most_c)),
                 percent(c), c <= row.most_c});
}

void judge_wrong_model(const FewSensorsRow& row, std::vector<Promise>& out) {
  if (row.errors.stiffness.published == 0) return;
  const double held = row.errors.held_ratio();
  out.push_back({fmt::format("{}: intervals of k with the model's error hold in {} at least",
                             row.name, percent(kMinHeld)),
                 percent_1(held), held >= kMinHeld});
}

}  // namespace

std::vector<Promise> promises(const Reproduction& all) {
  std::vector<Promise> out;
  if (all.seeds < kSeedsToJudge) return out;
  for (const BuildingReproduction& building : all.buildings)
    for (const AccuracyRow& row : building.rows) judge_row(row, out);
  if (all.robustness) judge(*all.robustness, out);
  for (const FewSensorsRow& row : all.few_sensors) judge(row, out);
  for (const FewSensorsRow& row : all.wrong_models) judge_wrong_model(row, out);
  return out;
}

}  // namespace framewatch::daemon
