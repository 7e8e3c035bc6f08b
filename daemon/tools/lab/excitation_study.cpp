// SPDX-License-Identifier: MIT
#include "daemon/tools/lab/excitation_study.h"

#include <algorithm>
#include <cmath>

#include "daemon/tools/lab/accuracy_trial.h"
#include "daemon/tools/lab/study_buildings.h"
#include "estimator/simulate/random.h"

namespace framewatch::daemon {
namespace {

constexpr double kLevels[] = {0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30};
constexpr double kFadingDuration_s = 15, kFadingFirstEnd_s = 10, kFadingEvery_s = 1;
constexpr double kSilence_mps2 = 1e-3;
constexpr double kBias_mps2 = 0.05, kRamp_mps3 = 0.001;

void count(const std::vector<estimator::WindowEstimate>& windows,
           const estimator::ParameterTable& table, const Eigen::VectorXd& truth,
           ExcitationLevel& level) {
  for (const estimator::WindowEstimate& window : windows) {
    for (int p = 0; p < table.size(); ++p) {
      const auto i = static_cast<std::size_t>(p);
      const auto kind = static_cast<std::size_t>(table[p].kind);
      ++level.all[kind];
      if (window.reason[i] != estimator::Observability::observable) continue;
      ++level.published[kind];
      if (std::abs(window.value[i] / truth[p] - 1) > kWrong[kind]) ++level.wrong[kind];
    }
  }
}

}  // namespace

int ExcitationSweep::published(int kind) const {
  int sum = 0;
  for (const ExcitationLevel& level : levels)
    sum += level.published[static_cast<std::size_t>(kind)];
  return sum;
}

double ExcitationSweep::wrong_ratio(int kind) const {
  int wrong = 0;
  for (const ExcitationLevel& level : levels) wrong += level.wrong[static_cast<std::size_t>(kind)];
  return published(kind) == 0 ? 0.0 : static_cast<double>(wrong) / published(kind);
}

ExcitationSweep study_excitation(const std::string& name, const estimator::Structure& structure,
                                 const Eigen::VectorXd& truth, bool noise_configured, int seeds,
                                 const Workers& workers) {
  const estimator::ParameterTable table(structure);
  constexpr int kCount = static_cast<int>(std::size(kLevels));
  std::vector<ExcitationLevel> pieces(static_cast<std::size_t>(kCount * seeds));
  workers.run("excitation, " + name, kCount * seeds, [&](int piece) {
    const auto seed = static_cast<std::uint64_t>(piece / kCount) + 1;
    ExcitationLevel& level = pieces[static_cast<std::size_t>(piece)];
    level.noise_ratio = kLevels[piece % kCount];
    const ExactRecord record =
        exact_record(structure, truth, oblique_motion(seed), level.noise_ratio, kFadingDuration_s);
    estimator::PipelineConfig config = trial_config(structure, record, truth, 0.2, 0.4, seed);
    if (!noise_configured)
      for (estimator::SensorAxis& axis : config.axes) axis.noise_density = 0;
    count(run_windows(config, with_noise(record, seed), kFadingFirstEnd_s, kFadingEvery_s), table,
          truth, level);
  });
  ExcitationSweep sweep{name, {}};
  for (int l = 0; l < kCount; ++l) {
    ExcitationLevel sum{kLevels[l], {}, {}, {}};
    for (std::size_t i = static_cast<std::size_t>(l); i < pieces.size(); i += kCount)
      for (std::size_t kind = 0; kind < 4; ++kind) {
        sum.all[kind] += pieces[i].all[kind];
        sum.published[kind] += pieces[i].published[kind];
        sum.wrong[kind] += pieces[i].wrong[kind];
      }
    sweep.levels.push_back(sum);
  }
  return sweep;
}

void listen_to_noise(const estimator::Structure& structure, const Eigen::VectorXd& design,
                     Silence& silence) {
  estimator::PipelineConfig config{structure, full_sensor_axes(structure), {}, design};
  config.options.rate_hz = kTrialRate_hz;
  if (silence.noise_configured)
    for (estimator::SensorAxis& axis : config.axes)
      axis.noise_density = kSilence_mps2 / std::sqrt(kTrialRate_hz / 2);
  const auto take = [&](const estimator::WindowEstimate& estimate) {
    if (estimate.rows == 0) return;
    ++silence.windows;
    silence.published += std::any_of(
        estimate.reason.begin(), estimate.reason.end(),
        [](estimator::Observability o) { return o == estimator::Observability::observable; });
  };
  estimator::Pipeline pipeline(config);
  estimator::Random random(1);
  const auto instants = std::llround(silence.hours * 3600 * kTrialRate_hz);
  for (std::int64_t i = 0; i < instants; ++i) {
    const estimator::Time time =
        estimator::from_microseconds(std::llround(static_cast<double>(i) * 1e6 / kTrialRate_hz));
    for (std::size_t a = 0; a < config.axes.size(); ++a)
      estimator::each_main_window(
          pipeline.push({time, static_cast<int>(a), kSilence_mps2 * random.normal()}), take);
  }
  estimator::each_main_window(pipeline.finish(), take);
}

double change_by_bias(const estimator::Structure& structure, const Eigen::VectorXd& truth,
                      std::uint64_t seed) {
  const estimator::ParameterTable table(structure);
  const ExactRecord record =
      exact_record(structure, truth, oblique_motion(seed), 0, kFadingDuration_s);
  const estimator::PipelineConfig config = trial_config(structure, record, truth, 0.1, 0.3, seed);
  Eigen::MatrixXd biased = record.accel_abs;
  for (Eigen::Index i = 0; i < biased.rows(); ++i)
    biased.row(i).array() += kBias_mps2 + kRamp_mps3 * static_cast<double>(i) / kTrialRate_hz;
  const auto clean = run_windows(config, record.accel_abs, kFadingFirstEnd_s, kFadingEvery_s);
  const auto disturbed = run_windows(config, biased, kFadingFirstEnd_s, kFadingEvery_s);
  double most = clean.empty() || clean.size() != disturbed.size() ? INFINITY : 0.0;
  for (std::size_t w = 0; w < clean.size() && w < disturbed.size(); ++w)
    for (int p = 0; p < table.size(); ++p)
      if (table[p].kind == estimator::ParameterKind::frame_stiffness)
        most = std::max(most, std::abs(disturbed[w].solution[static_cast<std::size_t>(p)] /
                                           clean[w].solution[static_cast<std::size_t>(p)] -
                                       1));
  return most;
}

}  // namespace framewatch::daemon
