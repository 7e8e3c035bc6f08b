// SPDX-License-Identifier: MIT
// Tests published values under little motion, biased sensors and random buildings. framewatch
// reproduce measures the same on more motions (docs/accuracy.md).

#include <gtest/gtest.h>

#include "daemon/tools/lab/accuracy_study.h"
#include "daemon/tools/lab/excitation_study.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::estimator {
namespace robustness_test {

constexpr double kMaxWrong = 0.05;         // of the published k off by more than 5 %
constexpr double kMaxChangeByBias = 1e-4;  // of any k
constexpr double kSilence_h = 0.1;         // of pure noise; reproduce runs an hour of it
constexpr double kRandomMedian[] = {0.005, 0.05, 0.03};  // k, G, c of random buildings, 1 % noise
constexpr double kMinCoverage = 0.85;  // few motions and overlapping windows: a coarse check

class Silence : public testing::TestWithParam<bool> {};

TEST_P(Silence, PublishesNothing) {
  daemon::Silence silence{"Table 1", kSilence_h, GetParam()};
  daemon::listen_to_noise(test::table1(), test::table1_theta(), silence);
  EXPECT_GT(silence.windows, 30'000);
  EXPECT_EQ(silence.published, 0);
}

INSTANTIATE_TEST_SUITE_P(NoiseDensity, Silence, testing::Bool(),
                         [](const auto& given) { return given.param ? "configured" : "unknown"; });

TEST(Excitation, FewPublishedStiffnessesAreWrong) {
  const daemon::ExcitationSweep sweep = daemon::study_excitation(
      "Table 1", test::table1(), test::table1_theta(), true, 2, daemon::Workers(1));
  ASSERT_GT(sweep.published(0), 500);
  EXPECT_LE(sweep.wrong_ratio(0), kMaxWrong);
  // all of them at 1 % noise, none when the noise is three times the motion or more
  EXPECT_EQ(sweep.levels[1].published[0], sweep.levels[1].all[0]);
  for (const daemon::ExcitationLevel& level : sweep.levels) {
    if (level.noise_ratio >= 3) {
      EXPECT_EQ(level.published[0] + level.published[1] + level.published[2], 0);
    }
  }
}

TEST(Bias, LeavesStiffnessesAlone) {
  EXPECT_LT(daemon::change_by_bias(test::table1(), test::table1_theta(), 1), kMaxChangeByBias);
}

TEST(RandomBuildings, AreIdentifiedLikeThePapers) {
  const daemon::AccuracyRow row = daemon::study_random_buildings(6, daemon::Workers(1));
  for (int kind = 0; kind < 3; ++kind) {
    const daemon::ErrorStatistics& s = row.of(daemon::Method::matched, kind);
    EXPECT_LT(s.quantile(0.5), kRandomMedian[kind]) << kind;
    EXPECT_GT(s.coverage_ratio(), kMinCoverage) << kind;
  }
}

TEST(PaperMethod, IsFarLessExactOnTheSameMotions) {
  constexpr double kTimesWorse = 5;
  const daemon::AccuracyCase c = daemon::accuracy_cases().front();
  const daemon::AccuracyRow row = daemon::study_accuracy(c, 2, daemon::Workers(1));
  for (const daemon::Method paper :
       {daemon::Method::paper_accel, daemon::Method::paper_example, daemon::Method::paper_denoised})
    EXPECT_GT(row.of(paper, 0).quantile(0.5),
              kTimesWorse * row.of(daemon::Method::matched, 0).quantile(0.5));
}

}  // namespace robustness_test
}  // namespace framewatch::estimator
