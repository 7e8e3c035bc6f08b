#include "tests/support/accuracy_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "estimator/simulate/linear_response.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::test {
namespace {

/// Two-sided 95 % point of Student's t with 20 degrees of freedom: batch means have 20 blocks.
constexpr double kStudent95 = 2.086;

double uniform(std::mt19937_64& random) {
  return (static_cast<double>(random() >> 11) + 0.5) * 0x1p-53;
}

double normal(std::mt19937_64& random) {
  const double radius = std::sqrt(-2 * std::log(uniform(random)));
  return radius * std::cos(2 * std::numbers::pi * uniform(random));
}

}  // namespace

std::vector<WindowEstimate> run_trial(const AccuracyTrial& trial) {
  const ParameterTable table(trial.structure);
  ResponseOptions response_options;
  response_options.rate_hz = trial.options.rate_hz;
  const Response response = linear_response(trial.structure, table, trial.truth, trial.motion,
                                            response_options, trial.duration_s);
  PipelineConfig config{trial.structure, full_sensor_axes(trial.structure), trial.options,
                        trial.design};
  std::vector<double> sigma;
  for (std::size_t a = 0; a < config.axes.size(); ++a) {
    const auto column = static_cast<Eigen::Index>(a);
    const double rms = std::sqrt(response.accel_abs.col(column).squaredNorm() /
                                 static_cast<double>(response.accel_abs.rows()));
    sigma.push_back(trial.noise_ratio * rms);
    config.axes[a].noise_density = sigma.back() / std::sqrt(trial.options.rate_hz / 2);
  }

  std::vector<WindowEstimate> kept;
  const double every_us = trial.every_s * 1e6;
  double next_us = 0;
  Pipeline pipeline(config, [&](const WindowEstimate& estimate) {
    const auto end_us = static_cast<double>(to_microseconds(estimate.end));
    if (estimate.rows == 0 || end_us < next_us) return;
    kept.push_back(estimate);
    next_us = end_us + every_us;
  });
  std::mt19937_64 random(trial.seed);
  for (Eigen::Index i = 0; i < response.accel_abs.rows(); ++i) {
    const Time time =
        from_microseconds(std::llround(static_cast<double>(i) * 1e6 / trial.options.rate_hz));
    for (std::size_t a = 0; a < config.axes.size(); ++a) {
      const double clean = response.accel_abs(i, static_cast<Eigen::Index>(a));
      pipeline.push({time, static_cast<int>(a), clean + sigma[a] * normal(random)});
    }
  }
  pipeline.finish();
  return kept;
}

Eigen::VectorXd perturbed_design(const ParameterTable& table, const Eigen::VectorXd& truth,
                                 double frame_stiffness_off, double other_off, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Eigen::VectorXd design = truth;
  for (int p = 0; p < table.size(); ++p) {
    const bool frame = table[p].kind == ParameterKind::frame_stiffness;
    design[p] *= 1 + (frame ? frame_stiffness_off : other_off) * (2 * uniform(random) - 1);
  }
  return design;
}

void collect_errors(const std::vector<WindowEstimate>& windows, const ParameterTable& table,
                    const Eigen::VectorXd& truth, ErrorsByKind& errors) {
  for (const WindowEstimate& window : windows) {
    for (int p = 0; p < table.size(); ++p) {
      const auto i = static_cast<std::size_t>(p);
      ErrorStatistics& kind = errors[static_cast<std::size_t>(table[p].kind)];
      kind.relative_error.push_back(std::abs(window.solution[i] / truth[p] - 1));
      if (window.reason[i] != Observability::observable) continue;
      ++kind.published;
      if (std::abs(window.value[i] - truth[p]) < kStudent95 * window.std_error[i]) ++kind.covered;
    }
  }
}

double ErrorStatistics::quantile(double probability) const {
  if (relative_error.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sorted = relative_error;
  std::sort(sorted.begin(), sorted.end());
  const double place = probability * static_cast<double>(sorted.size() - 1);
  return sorted[static_cast<std::size_t>(std::llround(place))];
}

double ErrorStatistics::published_ratio() const {
  return static_cast<double>(published) / static_cast<double>(relative_error.size());
}

double ErrorStatistics::coverage_ratio() const {
  if (published == 0) return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(covered) / published;
}

}  // namespace framewatch::test
