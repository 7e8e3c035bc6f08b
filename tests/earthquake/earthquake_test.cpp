// SPDX-License-Identifier: MIT
// Tests the studies of an earthquake's minutes with known answers and short runs of both.
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/workers.h"
#include "estimator/simulate/random.h"
#include "tests/earthquake/change_tables.h"
#include "tests/earthquake/coverage.h"
#include "tests/earthquake/interruption_tables.h"

namespace framewatch::earthquake {
namespace earthquake_test {

constexpr std::uint64_t kSeed = 1;

TEST(Coverage, OfGaussianErrorsIs95Percent) {
  constexpr int kCases = 2000, kValues = 10;
  estimator::Random random(5);
  Coverage right, too_small;
  for (int i = 0; i < kCases; ++i)
    for (int v = 0; v < kValues; ++v) {
      const double error = 0.3 * random.normal();
      right.add(i, 7 + error, 0.3, 7);
      too_small.add(i, 7 + error, 0.15, 7);
    }
  EXPECT_NEAR(right.ratio(), 0.95, 0.006);
  EXPECT_NEAR(right.std_error(), std::sqrt(0.95 * 0.05 / kCases / kValues), 3e-4);
  EXPECT_NEAR(right.rms_of_errors(), 1, 0.02);
  EXPECT_NEAR(too_small.ratio(), 0.673, 0.01);  // of a normal error within 0.98 of its deviation
  EXPECT_NEAR(too_small.rms_of_errors(), 2, 0.04);
}

TEST(Coverage, CountsAllValuesOfACaseOnce) {
  estimator::Random random(6);
  Coverage c;
  for (int i = 0; i < 1000; ++i) {
    const double error = random.normal();
    for (int v = 0; v < 50; ++v) c.add(i, error, 1, 0);
  }
  EXPECT_NEAR(c.std_error(), std::sqrt(0.95 * 0.05 / 1000), 2e-3);
}

TEST(ChangeCase, ComputesTheLossOfAGroup) {
  ChangeCase of;
  of.told = stories_with_channels(6, {2, 4, 6});
  of.truly = of.told.config.structure;
  of.theta = of.told.config.design;
  of.theta.head(6).setConstant(1e9);
  of.losses = {{10, 1, 0.2}, {20, 0, 0.2}};
  EXPECT_EQ(of.truth(9)[0], 0);
  EXPECT_NEAR(of.truth(15)[0], 1 / (0.5 + 0.5 / 0.8) - 1, 1e-12);
  EXPECT_NEAR(of.truth(25)[0], -0.2, 1e-12);
  EXPECT_NEAR(of.truth(25)[1], 0, 1e-12);
}

TEST(ChangeCase, DrawsTheSameCaseFromTheSameSeed) {
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(change_case(ChangeKind::loss, kSeed, i).text(),
              change_case(ChangeKind::loss, kSeed, i).text());
  EXPECT_NE(change_case(ChangeKind::loss, kSeed, 0).text(),
            change_case(ChangeKind::loss, kSeed + 1, 0).text());
}

/// A case of three stories of which the first one loses 20 % at 110 s.
ChangeCase plain_case() {
  ChangeCase of;
  of.told = three_stories();
  of.truly = of.told.config.structure;
  of.theta = of.told.config.design;
  of.losses = {{110, 0, 0.2}};
  return of;
}

TEST(ChangeScore, ScoresEveryAnnouncement) {
  const ChangeCase of = plain_case();
  ChangeRun run;
  run.watched = {true, true, true, false, false, false};
  const auto say = [&](double at_s, AnnouncementState state, int parameter, double ratio,
                       double error) {
    run.said.push_back({at_s, 1, state, parameter, error > 0, ratio, error});
  };
  say(100, AnnouncementState::raised, 2, -0.05, 0.01);     // nothing has changed yet
  say(112, AnnouncementState::raised, 0, 0, 0);            // without a size
  say(113, AnnouncementState::raised, 1, 0.02, 0.01);      // a neighbour that gains
  say(113.5, AnnouncementState::changed, 0, -0.25, 0.02);  // 2.5 errors off
  say(116, AnnouncementState::changed, 0, -0.20, 0.01);    // right, 2.5 errors from before
  say(120, AnnouncementState::cleared, 1, 0, 0);
  say(190, AnnouncementState::changed, 0, -0.19, 0.02);  // its error grew
  const CaseScore score = score_change(of, run);
  ASSERT_EQ(score.changed.size(), 1U);
  const ElementScore& e = score.changed[0];
  EXPECT_NEAR(e.delay_s, 2, 1e-9);
  EXPECT_EQ(e.said, 4);
  EXPECT_FALSE(e.shown[0].sized);
  EXPECT_TRUE(e.shown[2].sized);
  EXPECT_NEAR(e.shown[2].error, -0.05, 1e-12);
  EXPECT_NEAR(e.shown[3].error, 0, 1e-12);
  EXPECT_NEAR(e.shown.back().error, 0.01, 1e-12);
  EXPECT_EQ(e.pairs, 3);
  EXPECT_EQ(e.pairs_within, 1);
  EXPECT_TRUE(e.error_grew);
  EXPECT_EQ(score.unchanged, 2);
  EXPECT_EQ(score.neighbours, 1);
  EXPECT_EQ(score.standing, 0);
  EXPECT_EQ(score.gains, 1);
  EXPECT_EQ(score.early, 1);
}

/// An estimator that knows the truth up to a Gaussian error meets every requirement.
TEST(ChangeScore, AcceptsHonestErrors) {
  std::vector<ScoredCase> cases;
  estimator::Random random(8);
  for (int i = 0; i < 500; ++i) {
    ChangeCase of = plain_case();
    ChangeRun run;
    run.watched = {true, true, true, false, false, false};
    run.said.push_back(
        {111, 1, AnnouncementState::raised, 0, true, -0.2 + 0.01 * random.normal(), 0.01});
    const CaseScore score = score_change(of, run);
    cases.push_back({std::move(of), score});
  }
  for (const Demand& d : change_demands(cases, 1.5)) EXPECT_TRUE(d.holds) << d.text;
}

/// The simulation and the daemon's estimation agree on a simple loss. Without noise, linear.
TEST(Changes, FindAPlainLossWithItsSize) {
  ChangeCase of = plain_case();
  ChangeRunOptions options;
  options.noise_ratio = 1e-3;
  options.hop_s = 0.1;
  const ChangeRun run = run_change(of, options);
  EXPECT_TRUE(run.without_baseline.empty());
  const CaseScore score = score_change(of, run);
  ASSERT_EQ(score.changed.size(), 1U);
  // A window that holds a change is in doubt until its last block has left, 5 s and a block.
  EXPECT_LT(score.changed[0].delay_s, 6.5);
  ASSERT_TRUE(score.changed[0].shown.back().sized);
  EXPECT_NEAR(score.changed[0].shown.back().error, 0, 0.005);
  EXPECT_EQ(score.early, 0);
}

/// Without interruption and noise, and with the right design, values are right.
TEST(Interruptions, GiveExactValuesWithoutInterruption) {
  constexpr double kMaxError = 1e-3;  // of the sampled motion, without noise
  const InterruptionResult r = run_interruption({0, false, Interruption::none, 0, kSeed, 1e-6});
  for (const std::size_t window : {0U, 1U}) {
    EXPECT_LE(r.first[window].all_s, 0.2);  // 1-s windows are 0.2 s apart
    for (std::size_t t = 0; t < kErrorAt_s.size(); ++t) {
      ASSERT_EQ(r.error[window][t][stiffnesses].size(), 3U);
      for (const double e : r.error[window][t][stiffnesses]) EXPECT_LT(e, kMaxError);
    }
  }
}

TEST(Interruptions, CountTimeFromTheEndOfAnInterruption) {
  const InterruptionResult r =
      run_interruption({0, false, Interruption::all_missing, 2, kSeed, 0.01});
  const FirstWindow& first = r.first[kMain];
  EXPECT_GT(first.any_s, 0);
  EXPECT_LT(first.any_s, 10);
  EXPECT_GE(first.published_s, first.any_s - 1e-9);
  double while_it_lasts = 0;
  for (const auto& window : r.tally)
    for (const Tally& t : window[0]) while_it_lasts += t.count;
  EXPECT_EQ(while_it_lasts, 0);
}

TEST(Interruptions, GiveTheSameResultOnAnyNumberOfThreads) {
  std::vector<InterruptionCase> cases;
  for (const double length_s : {0.05, 0.5})
    cases.push_back({0, true, Interruption::one_missing, length_s, kSeed, 0.01});
  std::string text[2];
  for (const int threads : {1, 2}) {
    std::vector<InterruptionResult> results(cases.size());
    daemon::Workers(threads).run("", static_cast<int>(cases.size()), [&](int i) {
      results[static_cast<std::size_t>(i)] = run_interruption(cases[static_cast<std::size_t>(i)]);
    });
    text[threads - 1] = interruption_tables(cases, results);
  }
  EXPECT_EQ(text[0], text[1]);
}

}  // namespace earthquake_test
}  // namespace framewatch::earthquake
