// SPDX-License-Identifier: MIT
#include "tests/earthquake/change_run.h"

#include <algorithm>
#include <cmath>

namespace framewatch::earthquake {

ChangeRun run_change(const ChangeCase& of, const ChangeRunOptions& options) {
  estimator::PipelineConfig config = of.told.config;
  SofteningBuilding building(of.truly, of.theta, config.axes, of.softening, of.amount,
                             options.noise_ratio, of.seed);
  std::vector<double> sigma = building.sigma();
  for (double& s : sigma) s = std::max(s, 1e-9);  // without noise rows still need weights
  set_noise(sigma, config);
  config.options.rate_hz = SofteningBuilding::kRate_hz;
  config.options.hop_s = options.hop_s;
  estimator::WatchOptions watch;
  watch.learn_s = options.learn_s;
  Announcer announcer(config, watch);

  ChangeRun out;
  const int parameters = announcer.table().size();
  out.watched.assign(static_cast<std::size_t>(parameters), false);
  for (int p = 0; p < parameters; ++p) out.names.push_back(announcer.table()[p].name);
  const auto instants = std::llround(ChangeCase::kEnd_s * SofteningBuilding::kRate_hz);
  const auto learned = std::llround(ChangeCase::kLearned_s * SofteningBuilding::kRate_hz);
  std::size_t next = 0;
  for (std::int64_t i = 0; i < instants; ++i) {
    const double time_s = static_cast<double>(i) / SofteningBuilding::kRate_hz;
    while (next < of.losses.size() && of.losses[next].at_s <= time_s) {
      building.set_remaining(of.remaining(time_s));
      ++next;
    }
    const Eigen::VectorXd& accel = building.next(of.level(time_s));
    for (Eigen::Index a = 0; a < accel.size(); ++a)
      announcer.push({estimator::from_microseconds(10'000 * i), static_cast<int>(a), accel[a]});
    if (i != learned) continue;
    for (int p = 0; p < parameters; ++p) {
      if (!announcer.watched(p)) continue;
      out.watched[static_cast<std::size_t>(p)] = announcer.knows(p);
      if (!announcer.knows(p)) out.without_baseline.push_back(announcer.table()[p].name);
    }
  }
  announcer.finish();
  out.said = announcer.said();
  return out;
}

}  // namespace framewatch::earthquake
