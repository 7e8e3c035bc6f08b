// SPDX-License-Identifier: MIT
#include "daemon/tools/lab/table_test.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "daemon/tools/lab/data_files.h"
#include "daemon/tools/lab/demo_files.h"
#include "daemon/tools/simulation/scenario.h"
#include "daemon/tools/simulation/simulation.h"
#include "estimator/motion/svd_denoise.h"

namespace framewatch::daemon {
namespace {

constexpr int kWindows = 500;
constexpr double kShaken_s = 20, kWhole_s = 33, kForcedFrom_s = 10, kFreeFrom_s = 26;
constexpr double kPeak_mps2 = 2, kAngle_rad = std::numbers::pi / 6;

enum class Way { matched, paper, paper_denoised };
constexpr Way kWays[] = {Way::matched, Way::paper, Way::paper_denoised};
constexpr const char* kNames[] = {"framewatch", "paper's method", "paper's method, denoised"};

struct Stage {
  std::string name;
  double from_s;  ///< first window ends here
};

Eigen::MatrixXd prepared(const Eigen::MatrixXd& accel, Way way) {
  if (way != Way::paper_denoised) return accel;
  Eigen::MatrixXd out = accel;
  for (auto channel : out.colwise()) channel = estimator::svd_denoised(channel);
  return out;
}

/// Identifies the 500 windows of every stage by one method. Only framewatch has a gate.
std::vector<IdentifiedWindows> identify(estimator::PipelineConfig config,
                                        const Eigen::MatrixXd& accel,
                                        const std::vector<Stage>& stages, Way way) {
  if (way != Way::matched) {
    config.options.variant = estimator::Variant::paper;
    config.options.high_pass_hz = 0.1;
  }
  const auto size = static_cast<std::size_t>(estimator::ParameterTable(config.structure).size());
  std::vector<IdentifiedWindows> out(
      stages.size(), {kNames[static_cast<int>(way)], std::vector<std::vector<double>>(size)});
  const auto take = [&](const estimator::WindowEstimate& estimate) {
    if (estimate.rows == 0) return;
    const double end_s = 1e-6 * static_cast<double>(to_microseconds(estimate.end));
    for (std::size_t s = 0; s < stages.size(); ++s) {
      if (end_s < stages[s].from_s || out[s].values.front().size() == kWindows) continue;
      for (std::size_t p = 0; p < size; ++p)
        out[s].values[p].push_back(way == Way::matched ? estimate.value[p] : estimate.solution[p]);
    }
  };
  estimator::Pipeline pipeline(config);
  for (Eigen::Index i = 0; i < accel.rows(); ++i)
    for (Eigen::Index a = 0; a < accel.cols(); ++a)
      estimator::each_main_window(
          pipeline.push({estimator::from_microseconds(
                             std::llround(static_cast<double>(i) * 1e6 / config.options.rate_hz)),
                         static_cast<int>(a), accel(i, a)}),
          take);
  estimator::each_main_window(pipeline.finish(), take);
  return out;
}

TableTest run(const estimator::PipelineConfig& config, const Eigen::MatrixXd& accel,
              const std::vector<Stage>& stages, const Workers& workers) {
  TableTest test;
  const estimator::ParameterTable table(config.structure);
  for (int p = 0; p < table.size(); ++p) test.parameters.push_back(table[p]);
  for (const Stage& stage : stages)
    test.stages.push_back({stage.name, std::vector<IdentifiedWindows>(std::size(kWays))});
  workers.run("shaking table", static_cast<int>(std::size(kWays)), [&](int w) {
    auto windows = identify(config, prepared(accel, kWays[w]), stages, kWays[w]);
    for (std::size_t s = 0; s < stages.size(); ++s)
      test.stages[s].methods[static_cast<std::size_t>(w)] = std::move(windows[s]);
  });
  return test;
}

/// Returns the motion scaled to a peak, at rest after kShaken_s.
estimator::GroundMotion cut(estimator::GroundMotion motion) {
  const double scale = kPeak_mps2 / motion.peak();
  motion.accel.resize(std::min(
      motion.accel.size(), static_cast<std::size_t>(std::llround(kShaken_s / motion.step_s)) + 1));
  for (double& a : motion.accel) a *= scale;
  return motion;
}

}  // namespace

TableTest virtual_table_test(const std::string& data, const Workers& workers) {
  std::vector<ConfigProblem> problems;
  const auto building = parse_config("table_two_story.toml", kDemoConfig, problems);
  auto scenario = read_scenario(kDemoScenario, "scenario_table_two_story.toml", problems,
                                building ? &*building : nullptr);
  const auto recorded = el_centro_ns(data);
  scenario->duration_s = kWhole_s;
  scenario->motion = recorded
                         ? directed(cut(*recorded), kAngle_rad)
                         : estimator::PlanMotion{cut(scenario->motion.x), cut(scenario->motion.y)};
  Simulation simulation(*scenario);
  Eigen::MatrixXd accel(instants(*scenario),
                        static_cast<Eigen::Index>(scenario->config.pipeline.axes.size()));
  for (Eigen::Index i = 0; i < accel.rows(); ++i)
    accel.row(i) = Eigen::Map<const Eigen::RowVectorXd>(simulation.next().data(), accel.cols());
  TableTest test =
      run(scenario->config.pipeline, accel,
          {{"forced vibration", kForcedFrom_s}, {"free vibration", kFreeFrom_s}}, workers);
  test.motion = recorded ? "El Centro 1940 NS, scaled to 2 m/s^2"
                         : "a seeded Kanai-Tajimi motion (the data with El Centro are absent)";
  test.reference.assign(scenario->truth.begin(), scenario->truth.end());
  return test;
}

std::optional<TableTest> measured_table_test(const std::string& data, const Workers& workers) {
  const auto record = read_measured_run(data, measured_runs().front());
  std::vector<ConfigProblem> problems;
  const auto config = parse_config("mini_shake_table_xsens.toml", kMeasuredTableConfig, problems);
  if (!record || !config) return std::nullopt;
  Eigen::MatrixXd accel(record->time_s.size(), record->names.size());
  for (Eigen::Index a = 0; a < accel.cols(); ++a)
    accel.col(a) = Eigen::Map<const Eigen::VectorXd>(
        record->accel_mps2[static_cast<std::size_t>(a)].data(), accel.rows());
  if (!accel.allFinite()) return std::nullopt;
  Eigen::Index strongest = 0;
  (accel.col(0).array() - accel.col(0).mean()).abs().maxCoeff(&strongest);
  const double from_s = static_cast<double>(strongest) / config->pipeline.options.rate_hz + 1;
  TableTest test = run(config->pipeline, accel, {{"forced vibration", from_s}}, workers);
  test.motion = "Northridge, measured";
  test.reference.assign(test.parameters.size(), NAN);
  return test;
}

}  // namespace framewatch::daemon
