// SPDX-License-Identifier: MIT
#include "daemon/tools/lab/accuracy_study.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "daemon/base/numbers.h"
#include "daemon/tools/lab/accuracy_trial.h"
#include "daemon/tools/lab/study_buildings.h"
#include "estimator/identify/solve/batch_least_squares.h"
#include "estimator/refine/max_likelihood.h"
#include "estimator/simulate/linear_response.h"

namespace framewatch::daemon {
namespace {

constexpr double kStudyDuration_s = 15;
constexpr double kStudyEvery_s = 1;
constexpr double kRandomNoise = 0.01;

void collect(const Eigen::VectorXd& theta, const estimator::ParameterTable& table,
             const Eigen::VectorXd& truth, ErrorsByKind& errors) {
  for (int p = 0; p < table.size(); ++p)
    errors[static_cast<std::size_t>(table[p].kind)].relative_error.push_back(
        theta.size() > 0 ? std::abs(theta[p] / truth[p] - 1) : INFINITY);
}

ErrorsByKind& errors_of(SeedResult& result, Method method) {
  return result.errors[static_cast<std::size_t>(method)];
}

void run_paper_example(const estimator::Structure& structure,
                       const estimator::ParameterTable& table, const Eigen::VectorXd& truth,
                       const estimator::PlanMotion& motion, double noise_ratio, std::uint64_t seed,
                       SeedResult& result) {
  const auto rows = static_cast<Eigen::Index>(kPaper_s * kTrialRate_hz);
  const estimator::MotionHistory noisy =
      with_paper_noise(exact_motion(structure, table, truth, motion, kTrialRate_hz, rows),
                       kTrialRate_hz, noise_ratio, seed);
  result.paper_example = batch_least_squares(structure, table, noisy);
  collect(result.paper_example, table, truth, errors_of(result, Method::paper_example));
  collect(batch_least_squares(structure, table, denoised(noisy)), table, truth,
          errors_of(result, Method::paper_denoised));
}

/// Returns the first row of a record that is in the window.
Eigen::Index first_row(const estimator::WindowEstimate& window) {
  const double end_s = 1e-6 * static_cast<double>(to_microseconds(window.end));
  return std::llround(end_s * kTrialRate_hz) - window.rows;
}

void run_refinement(const estimator::PipelineConfig& config, const estimator::ParameterTable& table,
                    const Eigen::VectorXd& truth, const Eigen::MatrixXd& noisy,
                    SeedResult& result) {
  const estimator::WindowEstimate& window = result.first_window;
  Eigen::VectorXd start = config.design;
  for (int p = 0; p < table.size(); ++p)
    if (window.value[static_cast<std::size_t>(p)] > 0)
      start[p] = window.value[static_cast<std::size_t>(p)];
  const estimator::Refinement refinement = refine_max_likelihood(
      config.structure, config.axes, kTrialRate_hz,
      noisy.middleRows(first_row(window), window.rows + 1), config.design, start);
  collect(refinement.theta, table, truth, errors_of(result, Method::refined));
}

void add_bounds(const estimator::Structure& structure, const estimator::ParameterTable& table,
                const Eigen::VectorXd& truth, const ExactRecord& record,
                const std::vector<estimator::WindowEstimate>& windows, SeedResult& result) {
  for (const estimator::WindowEstimate& window : windows) {
    const estimator::CramerRaoBound bound =
        cramer_rao_bound(structure, record.axes, truth, kTrialRate_hz,
                         record.accel_abs.middleRows(first_row(window), window.rows + 1));
    if (result.first_bound.size() == 0) result.first_bound = bound.std_error;
    for (int p = 0; p < table.size(); ++p)
      result.bound[static_cast<std::size_t>(table[p].kind)].push_back(bound.std_error[p] /
                                                                      truth[p]);
  }
}

/// Runs `run` with seeds 1 .. seeds, and merges the results.
template <typename Run>
AccuracyRow row_of(const std::string& name, const std::string& what, int seeds,
                   const Workers& workers, const Run& run) {
  std::vector<SeedResult> results(static_cast<std::size_t>(seeds));
  workers.run(what, seeds, [&](int i) {
    results[static_cast<std::size_t>(i)] = run(static_cast<std::uint64_t>(i) + 1);
  });
  AccuracyRow row{name, {}, {}, {}};
  for (const SeedResult& result : results)
    for (std::size_t kind = 0; kind < 4; ++kind) {
      row.bound[kind].insert(row.bound[kind].end(), result.bound[kind].begin(),
                             result.bound[kind].end());
      for (std::size_t method = 0; method < kMethods; ++method)
        row.errors[method][kind].add(result.errors[method][kind]);
    }
  row.first_seed = std::move(results.front());
  return row;
}

constexpr double kSweepDuration_s = 10;

struct Piece {
  Eigen::VectorXd paper, denoised, matched;
};

Eigen::VectorXd matched(const estimator::Structure& structure,
                        const estimator::ParameterTable& table, const Eigen::VectorXd& truth,
                        const estimator::PlanMotion& motion, double noise_ratio,
                        std::uint64_t seed) {
  const ExactRecord record = exact_record(structure, truth, motion, noise_ratio, kSweepDuration_s);
  const auto windows = run_windows(trial_config(structure, record, truth, 0.1, 0.3, seed),
                                   with_noise(record, seed), 0, kTrialHop_s);
  if (windows.empty()) return Eigen::VectorXd::Constant(table.size(), NAN);
  return Eigen::Map<const Eigen::VectorXd>(windows.back().solution.data(), table.size());
}

/// Returns identified over given; NaN when nothing was identified.
Eigen::VectorXd ratio_to(const Eigen::VectorXd& truth, const Eigen::VectorXd& identified) {
  if (identified.size() == 0) return Eigen::VectorXd::Constant(truth.size(), NAN);
  return identified.cwiseQuotient(truth);
}

}  // namespace

std::vector<AccuracyCase> accuracy_cases() {
  const auto table_two = [](char variant, double noise, std::array<double, 3> limit) {
    return AccuracyCase{std::string("Table 2") + variant + (noise > 0.02 ? ", 5 %" : ", 1 %"),
                        std::string("table2") + variant,
                        table2(),
                        table2_theta(variant),
                        noise,
                        limit};
  };
  return {
      {"Table 1, 1 %", "table1", table1(), table1_theta(), 0.01, {0.0009, 0.015, 0.005}, true},
      {"Table 1, 5 %", "table1", table1(), table1_theta(), 0.05, {0.0043, 0.06, 0.024}, true},
      table_two('b', 0.01, {0.0009, 0.018, 0.011}),
      table_two('c', 0.01, {0.0030, 0.04, 0.03}),
      table_two('c', 0.05, {0.011, 0.12, 0.10}),
      table_two('d', 0.01, {0.007, 0.10, 0.045}),
  };
}

SeedResult run_seed(const estimator::Structure& structure, const Eigen::VectorXd& truth,
                    double noise_ratio, std::uint64_t seed) {
  const estimator::ParameterTable table(structure);
  const estimator::PlanMotion motion = oblique_motion(seed);
  const ExactRecord record = exact_record(structure, truth, motion, noise_ratio, kStudyDuration_s);
  const Eigen::MatrixXd noisy = with_noise(record, seed);
  estimator::PipelineConfig config = trial_config(structure, record, truth, 0.1, 0.3, seed);
  SeedResult result;
  const auto run = [&](Method method) {
    const auto windows = run_windows(config, noisy, kFirstEnd_s, kStudyEvery_s);
    collect_errors(windows, table, truth, errors_of(result, method));
    return windows;
  };
  const std::vector<estimator::WindowEstimate> windows = run(Method::matched);
  if (!windows.empty()) {
    result.first_window = windows.front();
    run_refinement(config, table, truth, noisy, result);
  }
  add_bounds(structure, table, truth, record, windows, result);

  for (estimator::SensorAxis& axis : config.axes) axis.noise_density = 0;
  run(Method::matched_unaware);
  config.options.variant = estimator::Variant::paper;
  config.options.high_pass_hz = 0.1;
  run(Method::paper_accel);
  run_paper_example(structure, table, truth, motion, noise_ratio, seed, result);
  return result;
}

double AccuracyRow::least_median(int kind) const {
  return kMedianOfNormal * median(bound[static_cast<std::size_t>(kind)]);
}

AccuracyRow study_accuracy(const AccuracyCase& c, int seeds, const Workers& workers) {
  return row_of(c.name, c.name, seeds, workers, [&](std::uint64_t seed) {
    return run_seed(c.structure, c.truth, c.noise_ratio, seed);
  });
}

ErrorsByKind study_exact_motion(const AccuracyCase& c, int motions, const Workers& workers) {
  const estimator::ParameterTable table(c.structure);
  std::vector<ErrorsByKind> pieces(static_cast<std::size_t>(motions));
  workers.run(c.group + " without noise", motions, [&](int i) {
    const auto seed = static_cast<std::uint64_t>(i) + 1;
    AccuracyTrial trial;
    trial.structure = c.structure;
    trial.truth = c.truth;
    trial.design = perturbed_design(table, c.truth, 0.1, 0.3, seed);
    trial.motion = oblique_motion(seed);
    trial.options.hop_s = kTrialHop_s;
    collect_errors(run_trial(trial), table, c.truth, pieces[static_cast<std::size_t>(i)]);
  });
  ErrorsByKind out;
  for (const ErrorsByKind& piece : pieces)
    for (std::size_t kind = 0; kind < 4; ++kind) out[kind].add(piece[kind]);
  return out;
}

AccuracyRow study_random_buildings(int seeds, const Workers& workers) {
  return row_of("random buildings, 1 %", "random buildings", seeds, workers,
                [](std::uint64_t seed) {
                  const RandomBuilding building = random_building(seed);
                  return run_seed(building.structure, building.truth, kRandomNoise, seed);
                });
}

NoiseSweep sweep_noise(const estimator::GroundMotion& motion, int seeds, const Workers& workers) {
  const estimator::Structure structure = table2();
  const estimator::ParameterTable table(structure);
  NoiseSweep out{table, {0, 0.01, 0.02, 0.03, 0.05, 0.07, 0.10}, {}, {}, {}};
  const Eigen::VectorXd truth = table2_theta('c');
  const estimator::PlanMotion plan = directed(motion, std::numbers::pi / 4);
  const auto rows = static_cast<Eigen::Index>(kSweepDuration_s * kTrialRate_hz);
  const estimator::MotionHistory exact =
      exact_motion(structure, table, truth, plan, kTrialRate_hz, rows);
  const int levels = static_cast<int>(out.noise_ratio.size());
  std::vector<Piece> pieces(static_cast<std::size_t>(levels * seeds));
  workers.run("noise on Table 2c", levels * seeds, [&](int i) {
    const double noise = out.noise_ratio[static_cast<std::size_t>(i % levels)];
    const auto seed = static_cast<std::uint64_t>(i / levels) + 1;
    const estimator::MotionHistory noisy = with_paper_noise(exact, kTrialRate_hz, noise, seed);
    pieces[static_cast<std::size_t>(i)] = {batch_least_squares(structure, table, noisy),
                                           batch_least_squares(structure, table, denoised(noisy)),
                                           matched(structure, table, truth, plan, noise, seed)};
  });
  for (int l = 0; l < levels; ++l) {
    const Eigen::VectorXd zero = Eigen::VectorXd::Zero(table.size());
    Piece mean{zero, zero, zero};
    for (int s = 0; s < seeds; ++s) {
      const Piece& piece = pieces[static_cast<std::size_t>(s * levels + l)];
      mean.paper += ratio_to(truth, piece.paper) / seeds;
      mean.denoised += ratio_to(truth, piece.denoised) / seeds;
      mean.matched += ratio_to(truth, piece.matched) / seeds;
    }
    out.paper.push_back(mean.paper);
    out.denoised.push_back(mean.denoised);
    out.matched.push_back(mean.matched);
  }
  return out;
}

}  // namespace framewatch::daemon
