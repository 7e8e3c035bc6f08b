// SPDX-License-Identifier: MIT
#include "daemon/tools/lab/reproduction.h"

#include <numbers>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/numbers.h"
#include "daemon/tools/lab/data_files.h"
#include "daemon/tools/lab/study_buildings.h"
#include "estimator/identify/solve/batch_least_squares.h"
#include "estimator/simulate/linear_response.h"

namespace framewatch::daemon {
namespace {

constexpr int kExcitationSeeds = 8;
constexpr int kExactMotions = 4;
constexpr double kSilence_h = 1;
constexpr const char* kStandIn =
    "a seeded Kanai-Tajimi motion (the paper's record is not in FRAMEWATCH_DATA)";

estimator::GroundMotion stand_in() {
  estimator::KanaiTajimi motion;
  motion.duration_s = 15;
  motion.seed = 1;
  return kanai_tajimi(motion);
}

std::string title_of(const std::string& group) {
  if (group == "table1") return "Table 1: five stories, one bay each way";
  const std::string floors = group == "table2b"   ? "flexible"
                             : group == "table2c" ? "basic"
                                                  : "stiff";
  return "Table 2(" + group.substr(6) + "): two stories, three bays each way, " + floors +
         " floors";
}

BuildingReproduction building(const AccuracyCase& c, const estimator::GroundMotion& ground) {
  const estimator::ParameterTable table(c.structure);
  BuildingReproduction out{c.group, title_of(c.group), table, c.truth, {}, {}, {}, {}};
  const estimator::PlanMotion motion = directed(ground, std::numbers::pi / 4);
  const auto rows = static_cast<Eigen::Index>(kPaper_s * kTrialRate_hz);
  out.paper = batch_least_squares(
      c.structure, table, exact_motion(c.structure, table, c.truth, motion, kTrialRate_hz, rows));
  const ExactRecord record = exact_record(c.structure, c.truth, motion, 0, kPaper_s);
  const auto windows = run_windows(trial_config(c.structure, record, c.truth, 0.1, 0.3, 1),
                                   record.accel_abs, 0, kTrialHop_s);
  if (!windows.empty())
    out.matched = Eigen::Map<const Eigen::VectorXd>(windows.back().solution.data(), table.size());
  return out;
}

Robustness robustness(int seeds, const Workers& workers) {
  Robustness out;
  for (const bool configured : {true, false}) {
    const std::string suffix = configured ? "" : ", noise not configured";
    out.sweeps.push_back(study_excitation("Table 1" + suffix, table1(), table1_theta(), configured,
                                          kExcitationSeeds, workers));
    out.sweeps.push_back(study_excitation("Table 2c" + suffix, table2(), table2_theta('c'),
                                          configured, kExcitationSeeds, workers));
    out.silences.push_back({"Table 1", kSilence_h, configured});
    out.silences.push_back({"Table 2c", kSilence_h, configured});
  }
  workers.run("an hour of noise", static_cast<int>(out.silences.size()), [&](int i) {
    const bool first = i % 2 == 0;
    listen_to_noise(first ? table1() : table2(), first ? table1_theta() : table2_theta('c'),
                    out.silences[static_cast<std::size_t>(i)]);
  });
  out.change_by_bias = change_by_bias(table1(), table1_theta(), 1);
  out.random_buildings = study_random_buildings(seeds, workers);
  return out;
}

constexpr const char* kJudgedKinds[] = {"k", "G", "c"};
constexpr double kMinCoverage = 0.90, kMaxCoverage = 0.98;
constexpr double kMaxWrong = 0.05;
constexpr double kMinHeld = 0.85;
constexpr double kMaxChangeByBias = 1e-4;
/// With fewer published values the share of intervals that hold is not judged.
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

void judge_median(const std::string& name, const char* kind, const ErrorStatistics& errors,
                  double limit, std::vector<Promise>& out) {
  const double found = errors.quantile(0.5);
  out.push_back({fmt::format("{}: median error of {} at most {}", name, kind, percent(limit)),
                 percent(found), found <= limit});
}

void judge_row(const AccuracyRow& row, std::vector<Promise>& out) {
  for (const AccuracyCase& c : accuracy_cases()) {
    if (c.name != row.name) continue;
    for (int kind = 0; kind < 3; ++kind)
      judge_median(row.name, kJudgedKinds[kind], row.of(Method::matched, kind),
                   c.limit[static_cast<std::size_t>(kind)], out);
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
  judge_median(row.name, "k", row.errors.stiffness, row.most_k, out);
  judge_median(row.name, "c", row.errors.damping, row.most_c, out);
}

void judge_wrong_model(const FewSensorsRow& row, std::vector<Promise>& out) {
  if (row.errors.stiffness.published == 0) return;
  const double held = row.errors.held_ratio();
  out.push_back({fmt::format("{}: intervals of k with the model's error hold in {} at least",
                             row.name, percent(kMinHeld)),
                 percent_1(held), held >= kMinHeld});
}

}  // namespace

const std::vector<std::string>& reproduction_cases() {
  static const std::vector<std::string> cases = {"table1", "table2b", "table2c",    "table2d",
                                                 "noise",  "denoise", "table-test", "few-sensors"};
  return cases;
}

Reproduction reproduce_paper(const std::string& only, int seeds, const std::string& data,
                             const Workers& workers) {
  const auto wanted = [&](const std::string& name) { return only.empty() || only == name; };
  const auto hachinohe = hachinohe_ns(data), el_centro = el_centro_ns(data);
  Reproduction out;
  out.seeds = seeds;
  out.hachinohe = hachinohe ? "Hachinohe 1968 NS" : kStandIn;
  out.el_centro = el_centro ? "El Centro 1940 NS" : kStandIn;
  out.motions_missing = !hachinohe || !el_centro;
  const estimator::GroundMotion first = hachinohe ? *hachinohe : stand_in();
  const estimator::GroundMotion second = el_centro ? *el_centro : stand_in();
  for (const AccuracyCase& c : accuracy_cases()) {
    if (!wanted(c.group)) continue;
    if (out.buildings.empty() || out.buildings.back().group != c.group) {
      out.buildings.push_back(building(c, first));
      out.buildings.back().exact = study_exact_motion(c, kExactMotions, workers);
    }
    out.buildings.back().rows.push_back(study_accuracy(c, seeds, workers));
  }
  if (wanted("noise") || wanted("denoise")) {
    const NoiseSweep sweep = sweep_noise(second, seeds, workers);
    if (wanted("noise")) out.noise = sweep;
    if (wanted("denoise")) out.denoise = sweep;
  }
  if (wanted("noise")) out.robustness = robustness(seeds, workers);
  if (wanted("few-sensors")) {
    out.few_sensors = study_few_sensors(seeds, workers);
    out.wrong_models = study_wrong_models(seeds, workers);
  }
  if (wanted("table-test")) {
    out.tables.push_back(virtual_table_test(data, workers));
    auto measured = measured_table_test(data, workers);
    out.measured_table_missing = !measured;
    if (measured) out.tables.push_back(std::move(*measured));
  }
  return out;
}

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
