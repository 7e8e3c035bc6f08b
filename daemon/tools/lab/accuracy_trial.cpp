// SPDX-License-Identifier: MIT
#include "daemon/tools/lab/accuracy_trial.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "daemon/tools/lab/study_buildings.h"
#include "estimator/motion/svd_denoise.h"
#include "estimator/numeric/quantile.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/random.h"
#include "estimator/simulate/sensor_model.h"

namespace framewatch::daemon {
namespace {

constexpr double kLow_hz = 0.075 / (2 * std::numbers::pi);
constexpr double kHigh_hz = 150 / (2 * std::numbers::pi);

void add_noise(Eigen::MatrixXd& channels, double rate_hz, double ratio, estimator::Random random) {
  for (auto channel : channels.colwise()) {
    const double rms = std::sqrt(channel.squaredNorm() / static_cast<double>(channel.size()));
    channel += ratio * rms * band_noise(channel.size(), rate_hz, kLow_hz, kHigh_hz, random);
  }
}

}  // namespace

estimator::PlanMotion oblique_motion(std::uint64_t seed) {
  estimator::KanaiTajimi motion;
  motion.duration_s = 15;
  motion.seed = seed;
  return directed(kanai_tajimi(motion), std::numbers::pi / 4);
}

ExactRecord exact_record(const estimator::Structure& structure, const Eigen::VectorXd& truth,
                         const estimator::PlanMotion& motion, double noise_ratio,
                         double duration_s) {
  estimator::ResponseOptions options;
  options.rate_hz = kTrialRate_hz;
  ExactRecord out{full_sensor_axes(structure),
                  linear_response(structure, estimator::ParameterTable(structure), truth, motion,
                                  options, duration_s)
                      .accel_abs};
  for (std::size_t a = 0; a < out.axes.size(); ++a) {
    const double rms =
        std::sqrt(out.accel_abs.col(static_cast<Eigen::Index>(a)).array().square().mean());
    out.axes[a].noise_density = estimator::noise_density_of(noise_ratio, rms, kTrialRate_hz);
  }
  return out;
}

Eigen::MatrixXd with_noise(const ExactRecord& record, std::uint64_t seed) {
  estimator::Random random(seed);
  Eigen::MatrixXd out = record.accel_abs;
  for (Eigen::Index a = 0; a < out.cols(); ++a) {
    const double sigma =
        record.axes[static_cast<std::size_t>(a)].noise_density * std::sqrt(kTrialRate_hz / 2);
    for (Eigen::Index i = 0; i < out.rows(); ++i) out(i, a) += sigma * random.normal();
  }
  return out;
}

estimator::PipelineConfig trial_config(const estimator::Structure& structure,
                                       const ExactRecord& record, const Eigen::VectorXd& truth,
                                       double k_off, double other_off, std::uint64_t seed) {
  estimator::PipelineConfig out{
      structure,
      record.axes,
      {},
      perturbed_design(estimator::ParameterTable(structure), truth, k_off, other_off, seed)};
  out.options.rate_hz = kTrialRate_hz;
  out.options.hop_s = kTrialHop_s;
  return out;
}

std::vector<CheckedWindow> run_checked_windows(const estimator::PipelineConfig& config,
                                               const Eigen::MatrixXd& accel, double from_s,
                                               double every_s) {
  std::vector<CheckedWindow> kept;
  estimator::ModelFit newest(static_cast<std::size_t>(config.parameters().size()));
  std::int64_t next_us = std::llround(1e6 * from_s);
  estimator::Pipeline pipeline(config);
  const int pipeline_rows = pipeline.window_rows();
  const auto take = [&](estimator::Pipeline::Results&& results) {
    for (const estimator::PipelineResult& result : results) {
      if (const estimator::WindowEstimate* e = result.estimate;
          e != nullptr && e->rows == pipeline_rows &&
          e->status != estimator::WindowStatus::warming_up && to_microseconds(e->end) >= next_us) {
        kept.push_back({*e, newest});
        next_us = to_microseconds(e->end) + std::llround(1e6 * every_s);
      }
      if (result.model != nullptr) newest = *result.model;
    }
  };
  for (Eigen::Index i = 0; i < accel.rows(); ++i) {
    const estimator::Time time = estimator::from_microseconds(
        std::llround(static_cast<double>(i) * 1e6 / config.options.rate_hz));
    for (Eigen::Index a = 0; a < accel.cols(); ++a)
      take(pipeline.push({time, static_cast<int>(a), accel(i, a)}));
  }
  take(pipeline.finish());
  return kept;
}

std::vector<estimator::WindowEstimate> run_windows(const estimator::PipelineConfig& config,
                                                   const Eigen::MatrixXd& accel, double from_s,
                                                   double every_s) {
  std::vector<estimator::WindowEstimate> out;
  for (CheckedWindow& window : run_checked_windows(config, accel, from_s, every_s))
    out.push_back(std::move(window.estimate));
  return out;
}

std::vector<estimator::WindowEstimate> run_trial(const AccuracyTrial& trial) {
  const ExactRecord record =
      exact_record(trial.structure, trial.truth, trial.motion, trial.noise_ratio, trial.duration_s);
  return run_windows({trial.structure, record.axes, trial.options, trial.design},
                     with_noise(record, trial.seed), 0, trial.every_s);
}

Eigen::VectorXd perturbed_design(const estimator::ParameterTable& table,
                                 const Eigen::VectorXd& truth, double frame_stiffness_off,
                                 double other_off, std::uint64_t seed) {
  estimator::Random random(seed);
  Eigen::VectorXd design = truth;
  for (int p = 0; p < table.size(); ++p) {
    const bool frame = table[p].kind == estimator::ParameterKind::frame_stiffness;
    design[p] *= 1 + (frame ? frame_stiffness_off : other_off) * (2 * random.uniform() - 1);
  }
  return design;
}

void collect_errors(const std::vector<estimator::WindowEstimate>& windows,
                    const estimator::ParameterTable& table, const Eigen::VectorXd& truth,
                    ErrorsByKind& errors) {
  for (const estimator::WindowEstimate& window : windows) {
    for (int p = 0; p < table.size(); ++p) {
      const auto i = static_cast<std::size_t>(p);
      if (static_cast<std::size_t>(table[p].kind) >= errors.size()) continue;
      ErrorStatistics& kind = errors[static_cast<std::size_t>(table[p].kind)];
      kind.relative_error.push_back(std::abs(window.solution[i] / truth[p] - 1));
      if (window.reason[i] != estimator::Observability::observable) continue;
      ++kind.published;
      if (std::abs(window.value[i] - truth[p]) < kStudent95 * window.std_error[i]) ++kind.covered;
    }
  }
}

double ErrorStatistics::quantile(double probability) const {
  return estimator::quantile(relative_error, probability);
}

void ErrorStatistics::add(const ErrorStatistics& other) {
  relative_error.insert(relative_error.end(), other.relative_error.begin(),
                        other.relative_error.end());
  published += other.published;
  covered += other.covered;
}

double ErrorStatistics::published_ratio() const {
  return static_cast<double>(published) / static_cast<double>(relative_error.size());
}

double ErrorStatistics::coverage_ratio() const {
  if (published == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(covered) / published;
}

estimator::MotionHistory with_paper_noise(const estimator::MotionHistory& exact, double rate_hz,
                                          double noise_ratio, std::uint64_t seed) {
  estimator::MotionHistory out = exact;
  if (noise_ratio <= 0) return out;
  add_noise(out.accel_abs, rate_hz, noise_ratio, estimator::Random(seed, 0));
  add_noise(out.vel_rel, rate_hz, noise_ratio, estimator::Random(seed, 1));
  add_noise(out.disp_rel, rate_hz, noise_ratio, estimator::Random(seed, 2));
  return out;
}

estimator::MotionHistory denoised(const estimator::MotionHistory& noisy) {
  estimator::MotionHistory out = noisy;
  for (Eigen::MatrixXd* channels : {&out.accel_abs, &out.vel_rel, &out.disp_rel})
    for (auto channel : channels->colwise()) channel = estimator::svd_denoised(channel);
  return out;
}

}  // namespace framewatch::daemon
