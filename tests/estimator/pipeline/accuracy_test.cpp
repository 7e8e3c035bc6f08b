// SPDX-License-Identifier: MIT
// Accuracy requirements for exact motion of the paper's buildings. The motion is the exact
// response (first-order hold at 1 ms, band-limited, decimated), not the estimator's scheme.

#include <cmath>
#include <ostream>
#include <tuple>

#include <gtest/gtest.h>

#include "daemon/tools/lab/accuracy_trial.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace accuracy_test {

using daemon::AccuracyTrial;
using daemon::ErrorsByKind;

constexpr double kLimit95[] = {2e-5, 2e-4, 2e-4, 2e-3};  // k, G, c, G_c relative
constexpr const char* kKind[] = {"k", "G", "c", "G_c"};

struct Building {
  Structure structure;
  Eigen::VectorXd truth;
};

Building building(char which) {
  if (which == '1') return {test::table1(), test::table1_theta()};
  return {test::table2(), test::table2_theta(which)};
}

class NoiseFree : public testing::TestWithParam<std::tuple<char, const char*>> {};

TEST_P(NoiseFree, ParametersWithinLimit) {
  const auto [which, record] = GetParam();
  const std::optional<GroundMotion> motion =
      std::string(record) == "el_centro" ? test::el_centro_ns() : test::hachinohe_ns();
  if (!motion) GTEST_SKIP() << "no ground motions under FRAMEWATCH_DATA";
  // GIVEN exact motion and a design off by up to 10 % in k and 30 % in G and c
  const Building b = building(which);
  const ParameterTable table(b.structure);
  AccuracyTrial trial;
  trial.structure = b.structure;
  trial.truth = b.truth;
  trial.motion = directed(*motion, M_PI / 4);
  trial.design = daemon::perturbed_design(table, b.truth, 0.1, 0.3, 7);
  trial.duration_s = 20;
  // WHEN the pipeline identifies it, THEN 95 % of the errors are below the limits
  ErrorsByKind errors;
  daemon::collect_errors(daemon::run_trial(trial), table, b.truth, errors);
  for (std::size_t kind = 0; kind < errors.size(); ++kind) {
    RecordProperty(kKind[kind], std::to_string(errors[kind].quantile(0.95)));
    EXPECT_LT(errors[kind].quantile(0.95), kLimit95[kind]) << kKind[kind];
    EXPECT_GE(errors[kind].relative_error.size(), 50u);
  }
}

INSTANTIATE_TEST_SUITE_P(PaperBuildings, NoiseFree,
                         testing::Combine(testing::Values('1', 'b', 'c', 'd'),
                                          testing::Values("el_centro", "hachinohe")),
                         [](const auto& parameters) {
                           return std::string("table_") + std::get<0>(parameters.param) + "_" +
                                  std::get<1>(parameters.param);
                         });

// Medians of |relative error| in 5-s windows under noise, docs/accuracy.md has the whole table.
struct NoisyCase {
  char which;
  double noise_ratio;
  double limit[3];  ///< k, G, c
};

void PrintTo(const NoisyCase& c, std::ostream* out) {
  *out << "table " << c.which << ", noise " << c.noise_ratio;
}

class Noisy : public testing::TestWithParam<NoisyCase> {};

TEST_P(Noisy, MediansWithinLimitAndIntervalsHonest) {
  constexpr int kMotions = 6;
  const NoisyCase c = GetParam();
  const Building b = building(c.which);
  const ParameterTable table(b.structure);
  ErrorsByKind errors;
  for (int seed = 1; seed <= kMotions; ++seed) {
    KanaiTajimi motion;
    motion.seed = static_cast<std::uint64_t>(seed) + 100;
    motion.duration_s = 15;
    AccuracyTrial trial;
    trial.structure = b.structure;
    trial.truth = b.truth;
    trial.motion = directed(kanai_tajimi(motion), M_PI / 4);
    trial.noise_ratio = c.noise_ratio;
    trial.seed = static_cast<std::uint64_t>(seed);
    trial.design =
        daemon::perturbed_design(table, b.truth, 0.1, 0.3, static_cast<std::uint64_t>(seed));
    daemon::collect_errors(daemon::run_trial(trial), table, b.truth, errors);
  }
  for (std::size_t kind = 0; kind < 3; ++kind) {
    EXPECT_LT(errors[kind].quantile(0.5), c.limit[kind]) << kKind[kind];
    EXPECT_GE(errors[kind].relative_error.size(), 60u);
    // Overlapping windows of few motions: a coarse check; the nominal level is 95 %.
    if (errors[kind].published > 300) {
      EXPECT_GT(errors[kind].coverage_ratio(), 0.85) << kKind[kind];
    }
  }
}

INSTANTIATE_TEST_SUITE_P(PaperBuildings, Noisy,
                         testing::Values(NoisyCase{'1', 0.01, {9e-4, 0.015, 0.005}},
                                         NoisyCase{'1', 0.05, {4.3e-3, 0.06, 0.024}},
                                         NoisyCase{'b', 0.01, {9e-4, 0.018, 0.011}},
                                         NoisyCase{'c', 0.01, {3e-3, 0.04, 0.03}},
                                         NoisyCase{'c', 0.05, {1.1e-2, 0.12, 0.10}},
                                         NoisyCase{'d', 0.01, {7e-3, 0.10, 0.045}}),
                         [](const auto& parameters) {
                           return std::string("table_") + parameters.param.which + "_" +
                                  std::to_string(std::lround(parameters.param.noise_ratio * 100)) +
                                  "_per_cent";
                         });

}  // namespace accuracy_test
}  // namespace framewatch::estimator
