// SPDX-License-Identifier: MIT
#include "tests/support/pipeline_run.h"

#include <cmath>

#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/random.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::test {

Eigen::MatrixXd shaken(const estimator::Structure& structure, const Eigen::VectorXd& theta,
                       double rate_hz, double duration_s, double noise_ratio) {
  estimator::KanaiTajimi parameters;
  parameters.duration_s = duration_s;
  parameters.strong_s = duration_s;
  parameters.build_up_s = 1;
  parameters.seed = 17;
  const estimator::PlanMotion motion = directed(kanai_tajimi(parameters), M_PI / 4);
  Eigen::MatrixXd accel = linear_response(structure, estimator::ParameterTable(structure), theta,
                                          motion, {.rate_hz = rate_hz, .longest_step_s = 2.5e-3})
                              .accel_abs;
  for (Eigen::Index axis = 0; axis < accel.cols() && noise_ratio > 0; ++axis) {
    estimator::Random random(3, static_cast<std::uint64_t>(axis));
    const double rms = accel.col(axis).norm() / std::sqrt(static_cast<double>(accel.rows()));
    for (double& a : accel.col(axis)) a += noise_ratio * rms * random.normal();
  }
  return accel;
}

estimator::PipelineConfig pipeline_config(const estimator::Structure& structure, double rate_hz) {
  estimator::PipelineConfig config;
  config.structure = structure;
  config.axes = full_sensor_axes(structure);
  config.options.rate_hz = rate_hz;
  return config;
}

estimator::AccelSample sample_at(const Eigen::MatrixXd& accel, double rate_hz, int instant,
                                 int axis) {
  return {estimator::from_microseconds(std::llround(1e6 * instant / rate_hz)), axis,
          accel(instant, axis)};
}

PipelineRun run_pipeline(const estimator::PipelineConfig& config, const Eigen::MatrixXd& accel,
                         const Delivered& delivered) {
  PipelineRun run;
  const auto take = [&](const estimator::WindowEstimate& e) { run.estimates.push_back(e); };
  estimator::Pipeline pipeline(config);
  for (int t = 0; t < accel.rows(); ++t)
    for (int axis = 0; axis < accel.cols(); ++axis)
      if (!delivered || delivered(t, axis))
        estimator::each_main_window(
            pipeline.push(sample_at(accel, config.options.rate_hz, t, axis)), take);
  estimator::each_main_window(pipeline.finish(), take);
  run.counters = pipeline.counters();
  return run;
}

}  // namespace framewatch::test
