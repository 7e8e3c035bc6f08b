// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/diagnose/verdict/diagnose.h"
#include "estimator/diagnose/verdict/effect_search.h"
#include "estimator/diagnose/verdict/verdict.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace search_limit_test {

const Effect& hidden() {
  static const Effect friction =
      test::effect_of(EffectKind::coulomb_friction, test::in_frame(1), {9e3, 0.004});
  return friction;
}

/// Diagnoses two records with friction. The time is over when that is asked for the `most`-th
/// time, or never if `most` is negative. asked: set to how often it is asked.
Diagnosis diagnosed(int most, int& asked) {
  const test::Recorded r(test::records_with({hidden()}, {1, 2}));
  DiagnosisOptions options = test::held_out_from(1);
  asked = 0;
  options.is_over = [&](double share) {
    EXPECT_TRUE(share == kSearchShare || share == 1);
    ++asked;
    return most >= 0 && asked >= most;
  };
  return diagnose(r.plant, r.segments, options);
}

bool is_whole(const Diagnosis& d) {
  return d.before.size() == 2 && d.after.size() == 2 && d.model.theta.size() > 0 &&
         d.declared.theta.size() > 0;
}

bool names_it(const Diagnosis& d) {
  return d.effects.size() == 1 && d.effects[0].chosen.kind == hidden().kind &&
         d.effects[0].chosen.place == hidden().place;
}

TEST(SearchLimit, EndsAtOnceWithTheLinearModel) {
  int asked = 0;
  const Diagnosis d = diagnosed(1, asked);
  EXPECT_TRUE(is_whole(d));
  EXPECT_TRUE(d.effects.empty());
  const std::vector<std::string> search = parts_not_done(SearchPart::labels);
  ASSERT_EQ(search.size(), 7U);
  ASSERT_GT(d.not_done.size(), search.size());  // models and gaps are left as they are too
  EXPECT_TRUE(std::equal(search.begin(), search.end(), d.not_done.begin()));
  EXPECT_EQ(d.verdict, Verdict::unexplained);
  EXPECT_EQ(d.before[1].overall, d.after[1].overall);
}

TEST(SearchLimit, ThatIsNotReachedChangesNothing) {
  int asked = 0;
  const Diagnosis never = diagnosed(-1, asked);
  const test::Recorded r(test::records_with({hidden()}, {1, 2}));
  const Diagnosis without = diagnose(r.plant, r.segments, test::held_out_from(1));
  EXPECT_GT(asked, 100);
  EXPECT_TRUE(never.not_done.empty());
  EXPECT_TRUE(names_it(never));
  ASSERT_TRUE(names_it(without));
  EXPECT_EQ(never.model.theta, without.model.theta);
  EXPECT_EQ(never.effects[0].confidence, without.effects[0].confidence);
}

TEST(SearchLimit, GivesAWholeDiagnosisWheneverItEnds) {
  int all = 0, asked = 0;
  (void)diagnosed(-1, all);
  bool named = false;
  for (int part = 1; part <= 5; ++part) {
    const Diagnosis d = diagnosed(part * all / 5, asked);
    EXPECT_TRUE(is_whole(d)) << part;
    EXPECT_FALSE(d.not_done.empty()) << part;
    for (const FoundEffect& f : d.effects) {
      EXPECT_LE(f.confidence, kDoubtful) << part;
      EXPECT_EQ(grade_of(f), Grade::leading) << part;
    }
    named |= names_it(d);
  }
  EXPECT_TRUE(named);
}

TEST(SearchLimit, GivesTheSameResultIfItEndsAtTheSamePiece) {
  int all = 0, asked = 0;
  (void)diagnosed(-1, all);
  const Diagnosis a = diagnosed(all / 4, asked), b = diagnosed(all / 4, asked);
  EXPECT_EQ(a.not_done, b.not_done);
  EXPECT_EQ(a.model.theta, b.model.theta);
  EXPECT_EQ(a.after[1].overall, b.after[1].overall);
}

}  // namespace search_limit_test

}  // namespace framewatch::estimator
