// What the estimator must reach on exact motion of the paper's buildings. The motion is the exact
// response (first-order hold at 1 ms, band-limited, decimated), not the estimator's own scheme.

#include <tuple>

#include <gtest/gtest.h>

#include "daemon/accuracy_trial.h"
#include "tests/support/paper_buildings.h"

namespace framewatch {
namespace {

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
  AccuracyTrial trial{b.structure, b.truth, {}, directed(*motion, M_PI / 4)};
  trial.design = daemon::perturbed_design(table, b.truth, 0.1, 0.3, 7);
  trial.duration_s = 20;
  // WHEN the pipeline identifies it, THEN 95 % of the errors are below the limits
  ErrorsByKind errors;
  daemon::collect_errors(daemon::run_trial(trial), table, b.truth, errors);
  for (std::size_t kind = 0; kind < errors.size(); ++kind) {
    RecordProperty(kKind[kind], std::to_string(errors[kind].quantile(0.95)));
    EXPECT_LT(errors[kind].quantile(0.95), kLimit95[kind]) << kKind[kind];
    EXPECT_GE(errors[kind].relative_error.size(), 80u);
  }
}

INSTANTIATE_TEST_SUITE_P(PaperBuildings, NoiseFree,
                         testing::Combine(testing::Values('1', 'b', 'c', 'd'),
                                          testing::Values("el_centro", "hachinohe")),
                         [](const auto& info) {
                           return std::string("table_") + std::get<0>(info.param) + "_" +
                                  std::get<1>(info.param);
                         });

}  // namespace
}  // namespace framewatch
