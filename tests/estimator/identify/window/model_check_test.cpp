// SPDX-License-Identifier: MIT
#include "estimator/identify/window/model_check.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/monitor/estimation/estimation.h"
#include "daemon/tools/lab/few_sensors.h"

namespace framewatch::estimator {
namespace model_check_test {

constexpr double kTwoSided95 = 1.96;
constexpr double kMustHold = 0.85;

struct Intervals {
  int published = 0, held = 0, held_by_noise = 0;
  double largest_misfit = 0, smallest_error = 1, largest_error = 0;
  double ratio() const { return static_cast<double>(held) / published; }
};

Intervals intervals(daemon::TallTrial trial, int seeds) {
  Intervals out;
  for (int seed = 1; seed <= seeds; ++seed) {
    trial.seed = static_cast<std::uint64_t>(seed);
    daemon::TallRecord record = daemon::tall_record(trial);
    record.config = daemon::with_design_error(record.config);
    const ParameterTable table = record.config.parameters();
    for (const daemon::CheckedWindow& w :
         daemon::run_checked_windows(record.config, record.accel, 20, 2.5))
      for (int p = 0; p < table.elements(); ++p) {
        const auto i = static_cast<std::size_t>(p);
        if (w.estimate.reason[i] != Observability::observable) continue;
        ++out.published;
        const double off = std::abs(w.estimate.value[i] / record.truth[p] - 1);
        const double noise = w.estimate.std_error[i] / w.estimate.value[i];
        const double model = std::isfinite(w.fit.error[i]) ? w.fit.error[i] : 0;
        out.held += off < kTwoSided95 * std::hypot(noise, model) ? 1 : 0;
        out.held_by_noise += off < kTwoSided95 * noise ? 1 : 0;
        if (std::isnan(w.fit.misfit[i])) continue;
        out.largest_misfit = std::max(out.largest_misfit, w.fit.misfit[i]);
        out.largest_error = std::max(out.largest_error, w.fit.error[i]);
        out.smallest_error = std::min(out.smallest_error, w.fit.error[i]);
      }
  }
  return out;
}

daemon::TallTrial trial() {
  daemon::TallTrial t;
  t.stiffness_off = t.damping_off = 0.1;
  t.duration_s = 40;
  return t;
}

daemon::TallTrial every_floor() {
  daemon::TallTrial t = trial();
  t.stories = 5;
  t.floors = {1, 2, 3, 4, 5};
  return t;
}

TEST(ModelCheck, IsSmallForTheRightModel) {
  for (const daemon::TallTrial& right : {trial(), every_floor()}) {
    const Intervals is = intervals(right, 1);
    EXPECT_GT(is.published, 20);
    EXPECT_LT(is.largest_misfit, 0.03);
    EXPECT_GT(is.smallest_error, 0.005);
    EXPECT_LT(is.largest_error, 0.03);
  }
}

TEST(ModelCheck, GrowsWithTheErrorOfTheMasses) {
  daemon::TallTrial masses = every_floor();
  masses.mass_off = 0.02;
  const Intervals is = intervals(masses, 4);
  EXPECT_GT(is.ratio(), kMustHold);
  EXPECT_LT(is.held_by_noise, 0.5 * is.published);
  EXPECT_LT(is.largest_error, 0.05);
}

TEST(ModelCheck, HoldsForGroupsOfWrongProfile) {
  daemon::TallTrial profile = trial();
  profile.profile_off = 0.05;
  profile.mass_off = 0.02;
  EXPECT_GT(intervals(profile, 3).ratio(), kMustHold);
}

TEST(ModelCheck, HoldsForABuildingThatBends) {
  for (daemon::TallTrial bends : {trial(), every_floor()}) {
    for (const double lowering : {1.0, 10.0}) {
      bends.bending_nmprad = (bends.stories == 5 ? 6e10 : 3e12) / lowering;
      const Intervals is = intervals(bends, 1);
      EXPECT_GT(is.published, 10) << bends.stories << " " << lowering;
      EXPECT_GE(is.ratio(), kMustHold) << bends.stories << " " << lowering;
      EXPECT_LT(is.held_by_noise, 0.2 * is.published);
      EXPECT_GT(is.largest_misfit, 0.1);
    }
  }
}

TEST(ModelCheck, HoldsForOtherDamping) {
  for (daemon::TallTrial damped : {trial(), every_floor()}) {
    damped.ground_damping_ratio = 0.03;
    EXPECT_GE(intervals(damped, 1).ratio(), kMustHold);
  }
}

}  // namespace model_check_test
}  // namespace framewatch::estimator
