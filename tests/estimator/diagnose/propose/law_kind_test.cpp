// SPDX-License-Identifier: MIT
#include "estimator/diagnose/propose/law_kind.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <memory>

#include <gtest/gtest.h>

#include "estimator/diagnose/propose/needed_signal.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace law_kind_test {

using test::Recorded;

constexpr int kFrame = 2;           // of 8e6 N/m; it deforms by about 16 mm, 0.2 m/s
constexpr double kMinShare = 0.85;  // of the force beyond noise that its kind explains
constexpr double kMaxOf = 0.75;     // of the force, if the law is strong

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
  EXPECT_GT(share_of(elastic, LawKind::elastic), kMinShare);
  const KindOfLaw hysteretic = kind_with(EffectKind::bouc_wen, {4e6, 4e-3, 1, 0.5});
  EXPECT_STREQ(law_kind_word(hysteretic.kind), "hysteretic");
  EXPECT_GT(share_of(hysteretic, LawKind::hysteretic), kMinShare);
  const KindOfLaw impact = kind_with(EffectKind::two_sided_gap, {8e6, 1e-2});
  EXPECT_STREQ(law_kind_word(impact.kind), "impact");
  EXPECT_GT(share_of(impact, LawKind::impact), kMinShare);
  const KindOfLaw dissipative = kind_with(EffectKind::coulomb_friction, {1.26e4, 4e-3});
  EXPECT_STREQ(law_kind_word(dissipative.kind), "dissipative");
}

/// A law that the catalog does not have.
class Unnamed : public ElementLaw {
 public:
  enum class Sort { tires, slackens, grows, waves, gives };
  explicit Unnamed(Sort sort) : sort_(sort) {}

  double force(double, double d, double v, std::span<const double>) const override {
    switch (sort_) {
      case Sort::tires:
        return kStiffness * std::clamp(d - slider_, -limit(), limit());
      case Sort::slackens:
        return kStiffness *
               (std::clamp(d - up_, 0.0, kYield) - std::clamp(-d - down_, 0.0, kYield));
      case Sort::grows:
        return kDamping * d * d * v;
      case Sort::waves:
        return 0.5 * kStiffness * kYield * std::sin(M_PI * d / kYield);
      case Sort::gives:
        break;
    }
    return -0.6 * kStiffness * (d - std::clamp(d, -kYield, kYield));
  }
  void begin_step(double, double d) override {
    const double elastic = std::clamp(d - slider_, -limit(), limit());
    slid_ += std::abs(d - elastic - slider_);
    slider_ = d - elastic;
    up_ = std::max(up_, d - kYield);
    down_ = std::max(down_, -d - kYield);
  }
  double stiffness_bound() const override { return kStiffness; }

 private:
  static constexpr double kStiffness = 4e6, kYield = 4e-3;  // N/m, m
  static constexpr double kDamping = 2e9;                   // N*s/m^3
  static constexpr double kTires = 0.1;                     // m, in which its strength falls to 1/e
  double limit() const { return kYield * std::exp(-slid_ / kTires); }

  Sort sort_;
  double slider_ = 0, slid_ = 0, up_ = 0, down_ = 0;
};

TEST(LawKind, IsFoundForUnnamedLaws) {
  const auto kind = [](Unnamed::Sort sort) {
    const Recorded recorded(
        {test::Small().record_with_law(kFrame, std::make_unique<Unnamed>(sort), 1)});
    return kind_of_law(recorded.fitter,
                       needed_signals(recorded.fitter, recorded.freed(test::in_frame(kFrame))));
  };
  const KindOfLaw tires = kind(Unnamed::Sort::tires), slackens = kind(Unnamed::Sort::slackens),
                  grows = kind(Unnamed::Sort::grows), waves = kind(Unnamed::Sort::waves),
                  gives = kind(Unnamed::Sort::gives);
  EXPECT_STREQ(law_kind_word(tires.kind), "hysteretic");
  EXPECT_GT(share_of(tires, LawKind::hysteretic), kMinShare);
  EXPECT_STREQ(law_kind_word(slackens.kind), "hysteretic");
  EXPECT_GT(share_of(slackens, LawKind::hysteretic), kMinShare);
  EXPECT_STREQ(law_kind_word(grows.kind), "dissipative");
  EXPECT_GT(share_of(grows, LawKind::dissipative), kMaxOf);
  EXPECT_STREQ(law_kind_word(waves.kind), "elastic") << "no contact";
  EXPECT_GT(share_of(waves, LawKind::elastic), share_of(waves, LawKind::impact) + 0.3);
  EXPECT_STREQ(law_kind_word(gives.kind), "elastic") << "softer beyond, no contact";
}

TEST(LawKind, IsUniqueExceptForStickingLaws) {
  const LawKind kinds[] = {LawKind::elastic, LawKind::impact, LawKind::dissipative,
                           LawKind::hysteretic, LawKind::time_varying};
  for (const EffectDescription& d : effect_catalogue()) {
    const auto of = std::count_if(std::begin(kinds), std::end(kinds),
                                  [&](LawKind kind) { return is_of_kind(d.kind, kind); });
    const bool law = d.kind <= EffectKind::two_sided_gap || d.kind == EffectKind::stiffness_drop ||
                     d.kind == EffectKind::stiffness_drift;
    const bool sticks =
        d.kind == EffectKind::coulomb_friction || d.kind == EffectKind::amplitude_dependence;
    EXPECT_EQ(of, sticks ? 2 : law ? 1 : 0) << d.name;
    EXPECT_FALSE(is_of_kind(d.kind, LawKind::external)) << d.name;
  }
  EXPECT_TRUE(is_of_kind(EffectKind::two_sided_gap, LawKind::impact));
  EXPECT_FALSE(is_of_kind(EffectKind::bouc_wen, LawKind::dissipative));
}

TEST(LawKind, GivesTheForceOverDeformationAndRate) {
  const RestoringSurface hardening = kind_with(EffectKind::cubic_stiffness, {2.25e10}).surface;
  // Cells that the motion hardly reached have no force. These are the outermost ones that have one.
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
