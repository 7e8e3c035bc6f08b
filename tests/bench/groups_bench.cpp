// SPDX-License-Identifier: MIT
// Measures the cost of a shift for buildings with sensors on few floors, beside the 5-story
// building of the paper's Table 1 with a sensor on every frame. One run, one core.
#include <cmath>
#include <cstdio>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/tools/lab/few_sensors.h"
#include "daemon/tools/lab/study_buildings.h"
#include "estimator/pipeline/pipeline.h"
#include "estimator/simulate/ground_motion.h"
#include "estimator/simulate/linear_response.h"

#include "estimator/simulate/random.h"
#include "estimator/simulate/sensor_model.h"
#include "tests/bench/cpu_clock.h"

namespace framewatch::bench {
namespace {

constexpr double kFrom_s = 40, kTo_s = 100;  // warm-up, tuning and first windows are over

/// Mean of a shift, us, without the largest hundredth: the main window and the model check, which
/// runs part of the time.
double shift_us(estimator::PipelineConfig config, const Eigen::MatrixXd& accel) {
  config.options.other_windows_s.clear();
  config.options.boxplot_windows = 1;
  int valid = 0;
  const auto take = [&](const estimator::WindowEstimate& e) {
    valid += e.status == estimator::WindowStatus::valid ? 1 : 0;
  };
  estimator::Pipeline pipeline(config);
  std::vector<double> times;
  for (Eigen::Index i = 0; i < accel.rows(); ++i) {
    const estimator::Time time = estimator::from_microseconds(10'000 * i);
    const double begin = wall_us();
    for (int a = 0; a < accel.cols(); ++a)
      estimator::each_main_window(pipeline.push({time, a, accel(i, a)}), take);
    if (static_cast<double>(i) > kFrom_s * daemon::kTrialRate_hz)
      times.push_back(wall_us() - begin);
  }
  if (valid == 0) std::printf("  (nothing was identified)\n");
  const double most = quantile(times, 0.99);
  std::erase_if(times, [&](double t) { return t > most; });
  return std::accumulate(times.begin(), times.end(), 0.0) / static_cast<double>(times.size());
}

double planar_us(int stories, const std::vector<int>& floors) {
  daemon::TallTrial trial;
  trial.stories = stories;
  trial.floors = floors;
  trial.duration_s = kTo_s;
  const daemon::TallRecord record = daemon::tall_record(trial);
  return shift_us(record.config, record.accel);
}

/// Noisy motion of every axis, of the building as designed.
double designed_us(const estimator::PipelineConfig& config) {
  estimator::KanaiTajimi ground;
  ground.duration_s = ground.strong_s = kTo_s;
  estimator::ResponseOptions options;
  estimator::ResponseStream response(config.structure, estimator::ParameterTable(config.structure),
                                     config.design, directed(kanai_tajimi(ground), 0.7), options,
                                     {}, response_channels(config.structure, config.axes));
  Eigen::MatrixXd accel(static_cast<Eigen::Index>(kTo_s * daemon::kTrialRate_hz),
                        static_cast<Eigen::Index>(config.axes.size()));
  estimator::Random random(5);
  for (Eigen::Index i = 0; i < accel.rows(); ++i) {
    accel.row(i) = response.next().transpose();
    for (Eigen::Index a = 0; a < accel.cols(); ++a) accel(i, a) += 1e-3 * random.normal();
  }
  return shift_us(config, accel);
}

double table1_us() {
  estimator::PipelineConfig config{daemon::table1(), {}, {}, daemon::table1_theta()};
  config.axes = daemon::full_sensor_axes(config.structure);
  for (estimator::SensorAxis& axis : config.axes)
    axis.noise_density = 1e-3 / std::sqrt(daemon::kTrialRate_hz / 2);
  return designed_us(config);
}

int run(const std::string& tall_config) {
  std::vector<daemon::ConfigProblem> problems;
  const std::optional<daemon::Config> tall = daemon::load_config(tall_config, problems);
  if (!tall) return 1;
  const double reference = table1_us();
  std::printf("%-48s %8s %8s\n", "", "us", "ratio");
  const auto line = [&](const char* name, double us) {
    std::printf("%-48s %8.1f %8.2f\n", name, us, us / reference);
  };
  line("Table 1: 5 stories, every frame", reference);
  line("20 stories, 4 groups, planar", planar_us(20, {5, 10, 15, 20}));
  line("100 stories, 4 groups, planar", planar_us(100, {25, 50, 75, 100}));
  line("300 stories, 4 groups, planar", planar_us(300, {75, 150, 225, 300}));
  line("20 stories, 4 groups, 4 frames on rigid floors", designed_us(tall->pipeline));
  return 0;
}

}  // namespace
}  // namespace framewatch::bench

int main(int argc, char** argv) {
  return framewatch::bench::run(argc > 1 ? argv[1]
                                         : FRAMEWATCH_SOURCE_DIR "/configs/tall_20_stories.toml");
}
