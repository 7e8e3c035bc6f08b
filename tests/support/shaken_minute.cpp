// SPDX-License-Identifier: MIT
#include "tests/support/shaken_minute.h"

#include <cmath>

#include "daemon/tools/lab/accuracy_trial.h"
#include "daemon/tools/lab/study_buildings.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/sensor_model.h"

namespace framewatch::test {

ShakenMinute::ShakenMinute()
    : structure_(daemon::table1()), table_(structure_), frame_(table_.frame_stiffness(1, 0)) {}

std::vector<double> ShakenMinute::windows_s() const {
  return estimator::window_lengths_s({});
}

Eigen::MatrixXd ShakenMinute::motion(std::uint64_t seed, bool damaged) const {
  estimator::KanaiTajimi ground;
  ground.duration_s = kDuration_s + 1, ground.build_up_s = 1, ground.strong_s = kDuration_s;
  ground.seed = seed;
  const Eigen::VectorXd truth = daemon::table1_theta();
  std::vector<estimator::ParameterChange> changes;
  if (damaged) {
    changes.push_back({kDamage_s, truth});
    changes.back().theta[frame_] *= 1 - kDamage;
  }
  estimator::ResponseStream stream(structure_, table_, truth,
                                   directed(kanai_tajimi(ground), M_PI / 4), {}, changes);
  const auto axes = static_cast<Eigen::Index>(daemon::full_sensor_axes(structure_).size());
  Eigen::MatrixXd out(std::lround(kDuration_s * daemon::kTrialRate_hz) + 1, axes);
  for (Eigen::Index i = 0; i < out.rows(); ++i) out.row(i) = stream.next().head(axes).transpose();
  return out;
}

void ShakenMinute::run(std::uint64_t seed, bool damaged,
                       const std::function<void(const estimator::WindowEstimate&)>& take) const {
  daemon::ExactRecord record{daemon::full_sensor_axes(structure_), motion(seed, damaged)};
  for (std::size_t a = 0; a < record.axes.size(); ++a) {
    const auto column = record.accel_abs.col(static_cast<Eigen::Index>(a)).array();
    record.axes[a].noise_density = estimator::noise_density_of(
        kNoise, std::sqrt(column.square().mean()), daemon::kTrialRate_hz);
  }
  const Eigen::MatrixXd accel = daemon::with_noise(record, seed + 1000);
  estimator::PipelineConfig config{
      structure_,
      record.axes,
      {},
      daemon::perturbed_design(table_, daemon::table1_theta(), 0.1, 0.3, seed + 77)};
  config.options.hop_s = 0.25;
  estimator::Pipeline pipeline(config);
  for (Eigen::Index i = 0; i < accel.rows(); ++i)
    for (Eigen::Index a = 0; a < accel.cols(); ++a)
      estimator::each_window(pipeline.push({estimator::from_microseconds(10'000 * i),
                                            static_cast<int>(a), accel(i, a)}),
                             take);
  estimator::each_window(pipeline.finish(), take);
}

}  // namespace framewatch::test
