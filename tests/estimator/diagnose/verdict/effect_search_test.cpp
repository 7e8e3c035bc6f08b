// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/effect_search.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "estimator/diagnose/verdict/diagnose.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace effect_search_test {

struct Told {
  std::vector<std::string> what;
  std::vector<double> done, then;

  ReportProgress listener() {
    return [this](const std::string& now, double share, double after) {
      what.push_back(now);
      done.push_back(share);
      then.push_back(after);
    };
  }
};

void nothing(int) {}

void expect_near(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-12) << i;
}

TEST(SearchProgress, CountsTheWorkOfAStage) {
  Told told;
  SearchProgress progress(told.listener(), {});
  const Parallel counted = progress.counted();
  progress.begin("a", 0.2, 0.6, {0.5, 0.25});
  counted(2, nothing);
  progress.describe("b");
  counted(1, nothing);
  counted(1, nothing);  // beyond the listed calls: half of the rest
  expect_near(told.done, {0.2, 0.2, 0.4, 0.4, 0.4, 0.5, 0.5, 0.55});
  expect_near(told.then, {0.2, 0.4, 0.4, 0.4, 0.5, 0.5, 0.55, 0.55});
  EXPECT_EQ(told.what, (std::vector<std::string>{"a", "a", "a", "b", "b", "b", "b", "b"}));
}

TEST(SearchProgress, NeverDecreasesNorExceedsItsStage) {
  Told told;
  SearchProgress progress(told.listener(), {});
  const Parallel counted = progress.counted();
  progress.begin("a", 0, 0.5, {0.9, 0.9});
  for (int i = 0; i < 3; ++i) counted(3, nothing);
  EXPECT_NEAR(told.done.back(), 0.5, 1e-12);
  progress.begin("b", 0.3, 0.4);
  counted(2, nothing);
  EXPECT_NEAR(told.done.back(), 0.5, 1e-12);
}

TEST(SearchProgress, UsesTheGivenWorkers) {
  int calls = 0;
  SearchProgress progress({}, [&](int count, const std::function<void(int)>& work) {
    ++calls;
    for (int i = 0; i < count; ++i) work(i);
  });
  int done = 0;
  progress.counted()(4, [&](int i) { done += i; });
  EXPECT_EQ(calls, 1);
  EXPECT_EQ(done, 6);
}

Diagnosis diagnosed(const std::vector<Effect>& effects) {
  const test::Recorded r(test::records_with(effects, {1, 2}));
  return diagnose(r.plant, r.segments, test::held_out_from(1));
}

bool names(const Diagnosis& d, const Effect& effect) {
  return std::any_of(d.effects.begin(), d.effects.end(), [&](const FoundEffect& found) {
    return found.chosen.kind == effect.kind && found.chosen.place == effect.place;
  });
}

/// Noise that is stated too small is a misfit that no place explains.
TEST(EffectSearch, TriesNoLawIfNoPlaceExplainsEnough) {
  constexpr double kStated = 0.8;  // of the variance
  test::Recorded r(test::records_with({}, {1, 2}));
  for (RecordSegment& segment : r.segments) segment.variance *= kStated;
  DiagnosisOptions options = test::held_out_from(1);
  Told told;
  options.progress = told.listener();
  const Diagnosis d = diagnose(r.plant, r.segments, options);
  EXPECT_TRUE(d.effects.empty());
  EXPECT_TRUE(d.rejected.empty());
  EXPECT_FALSE(d.where.empty());
  EXPECT_TRUE(std::none_of(told.what.begin(), told.what.end(), [](const std::string& what) {
    return what.find("laws") != std::string::npos;
  }));
}

TEST(TwoEffects, MayShareAPlaceIfOneChangesWithTime) {
  const Effect friction =
      test::effect_of(EffectKind::coulomb_friction, test::in_frame(1), {9e3, 0.004});
  const Effect drop = test::effect_of(EffectKind::stiffness_drop, test::in_frame(1), {-1.6e6, 6});
  const Diagnosis d = diagnosed({friction, drop});
  EXPECT_EQ(d.effects.size(), 2U);
  EXPECT_TRUE(names(d, friction));
  EXPECT_TRUE(names(d, drop));
}

}  // namespace effect_search_test

}  // namespace framewatch::estimator
