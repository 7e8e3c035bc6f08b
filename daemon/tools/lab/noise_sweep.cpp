#include "daemon/tools/lab/noise_sweep.h"

#include <cmath>
#include <numbers>

#include "daemon/tools/lab/accuracy_trial.h"
#include "daemon/tools/lab/paper_buildings.h"
#include "daemon/tools/lab/paper_method.h"
#include "estimator/identify/solve/batch_least_squares.h"
#include "estimator/simulate/linear_response.h"

namespace framewatch::daemon {
namespace {

constexpr double kSweepDuration_s = 10;
constexpr double kSweepHop_s = 0.25;

struct Piece {
  Eigen::VectorXd paper, denoised, matched;
};

Eigen::VectorXd matched(const estimator::Structure& structure,
                        const estimator::ParameterTable& table, const Eigen::VectorXd& truth,
                        const estimator::PlanMotion& motion, double noise_ratio,
                        std::uint64_t seed) {
  const ExactRecord record = exact_record(structure, truth, motion, noise_ratio, kSweepDuration_s);
  estimator::PipelineConfig config{
      structure, record.axes, {}, perturbed_design(table, truth, 0.1, 0.3, seed)};
  config.options.rate_hz = kTrialRate_hz;
  config.options.hop_s = kSweepHop_s;
  const auto windows = run_windows(config, with_noise(record, seed), 0, kSweepHop_s);
  if (windows.empty()) return Eigen::VectorXd::Constant(table.size(), NAN);
  return Eigen::Map<const Eigen::VectorXd>(windows.back().solution.data(), table.size());
}

/// Identified over given; NaN when there is nothing identified.
Eigen::VectorXd ratio_to(const Eigen::VectorXd& truth, const Eigen::VectorXd& identified) {
  if (identified.size() == 0) return Eigen::VectorXd::Constant(truth.size(), NAN);
  return identified.cwiseQuotient(truth);
}

}  // namespace

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
