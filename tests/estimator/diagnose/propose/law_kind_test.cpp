#include "estimator/diagnose/propose/law_kind.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <gtest/gtest.h>

#include "estimator/diagnose/propose/needed_signal.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace law_kind_test {

using test::Recorded;

constexpr int kFrame = 2;             // of 8e6 N/m; it deforms by about 16 mm, 0.2 m/s
constexpr double kLeastShare = 0.85;  // of the force beyond noise that its kind explains

KindOfLaw kind_with(EffectKind kind, std::initializer_list<double> values) {
  Effect effect = make_effect(kind, test::in_frame(kFrame));
  std::copy(values.begin(), values.end(), effect.values.begin());
  const Recorded recorded(test::records_with({effect}));
  return kind_of_law(recorded.fitter,
                     needed_signals(recorded.fitter, recorded.freed(effect.place)));
}

double share_of(const KindOfLaw& of, LawKind kind) {
  return of.share[static_cast<std::size_t>(kind)];
}

TEST(LawKind, IsFoundWithoutAFormula) {
  const KindOfLaw elastic = kind_with(EffectKind::cubic_stiffness, {2.25e10});
  EXPECT_STREQ(law_kind_word(elastic.kind), "elastic");
  EXPECT_GT(share_of(elastic, LawKind::elastic), kLeastShare);
  const KindOfLaw hysteretic = kind_with(EffectKind::bouc_wen, {4e6, 4e-3, 1, 0.5});
  EXPECT_STREQ(law_kind_word(hysteretic.kind), "hysteretic");
  EXPECT_GT(share_of(hysteretic, LawKind::hysteretic), kLeastShare);
  const KindOfLaw dissipative = kind_with(EffectKind::coulomb_friction, {1.26e4, 4e-3});
  EXPECT_STREQ(law_kind_word(dissipative.kind), "dissipative");
}

TEST(LawKind, DrawsTheForceOverDeformationAndRate) {
  const RestoringSurface hardening = kind_with(EffectKind::cubic_stiffness, {2.25e10}).surface;
  // Cells that the motion hardly reached have no force: the outermost that have one.
  const Eigen::Index middle = hardening.v_mps.size() / 2;
  Eigen::Index first = 0, last = hardening.d_m.size() - 1;
  while (first < last && std::isnan(hardening.force_n(first, middle))) ++first;
  while (last > first && std::isnan(hardening.force_n(last, middle))) --last;
  ASSERT_LT(hardening.d_m[first], 0.5 * hardening.d_m[0]) << "far out on either side";
  ASSERT_GT(hardening.d_m[last], 0.5 * hardening.d_m[hardening.d_m.size() - 1]);
  EXPECT_GT(hardening.force_n(last, middle), 0) << "beyond a linear spring, far out";
  EXPECT_LT(hardening.force_n(first, middle), 0);
  EXPECT_GT(hardening.count.sum(), 0);
}

}  // namespace law_kind_test
}  // namespace framewatch::estimator
