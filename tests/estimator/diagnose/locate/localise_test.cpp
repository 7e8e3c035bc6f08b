// SPDX-License-Identifier: MIT
#include "estimator/diagnose/locate/localise.h"

#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/law_tracks.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "tests/estimator/diagnose/exact_record.h"

namespace framewatch::estimator {
namespace localise_test {

using Eigen::Index;
using Eigen::MatrixXd;
using test::Small;
using Kind = CandidatePlace::Kind;

constexpr int kSteps = 8;

struct Case {
  Small small;
  Plant plant = small.plant();
  std::vector<RecordSegment> segments;
  Fitter fitter;
  std::vector<CandidatePlace> all = candidate_places_of(plant, initial_model(plant));

  explicit Case(const MatrixXd& record)
      : segments(small.segments({record})), fitter(plant, segments, {}) {}

  const CandidatePlace& at(Kind kind, const EffectPlace& place) const {
    for (const CandidatePlace& c : all)
      if (c.kind == kind && c.place == place) return c;
    throw std::out_of_range("no such place");
  }
  Localisation localised(const CandidatePlace& place) const {
    return localise(fitter, initial_model(plant), {}, {place}, kSteps);
  }
  /// Returns the excess of a place's misfit over noise, in standard deviations of noise.
  double beyond_noise(const Localisation& l) const {
    return (l.ratio - 1) * std::sqrt(fitter.expected(l.model) * 0.75);
  }
};

struct Hidden {
  Effect effect;
  Kind kind;
  EffectPlace place;  // of the candidate
};

std::vector<Hidden> hidden_effects() {
  using enum EffectKind;
  const auto building = test::building_place(Direction::y);
  return {
      {test::cubic_spring(2, 2e11).simulated, Kind::element, test::frame_place(2)},
      {test::with_values(coulomb_friction, test::panel_place(0), {4000, 2e-3}), Kind::element,
       test::panel_place(0)},
      {test::with_values(two_sided_gap, test::frame_place(0), {6e6, 3e-3}), Kind::element,
       test::frame_place(0)},
      // To the ground in the first story, so it equals its frame.
      {test::with_values(tuned_mass_damper, test::node_place(3), {3000, 2.2, 0.05}), Kind::element,
       test::frame_place(3)},
      {test::extra_mass(1, 8000).simulated, Kind::crossing, test::crossing_place(1)},
      {test::with_values(base_rocking, building, {1e9}), Kind::rocking, building},
  };
}

class LocaliseHidden : public testing::TestWithParam<std::size_t> {};

TEST_P(LocaliseHidden, LeavesNoiseOnlyAtTheTruePlace) {
  constexpr double kChance = 4.5;
  const Hidden hidden = hidden_effects()[GetParam()];
  const Case c(Small().record({hidden.effect}, 3));
  const Localisation own = c.localised(c.at(hidden.kind, hidden.place));
  EXPECT_LT(std::abs(c.beyond_noise(own)), kChance);
  ASSERT_EQ(own.record_ratio.size(), 1U);
  EXPECT_NEAR(own.record_ratio.front(), own.ratio, 1e-6);
  // A frame of the other direction explains none of it.
  const int other = hidden.place.frame == 0 ? 2 : 0;
  const Localisation wrong = c.localised(c.at(Kind::element, test::frame_place(other)));
  EXPECT_GT(wrong.misfit, own.misfit);
}

INSTANTIATE_TEST_SUITE_P(AtEveryKindOfPlace, LocaliseHidden,
                         testing::Range(std::size_t{0}, hidden_effects().size()));

TEST(Localise, ReachesTheNoiseInAFewStepsFromAFarModel) {
  constexpr double kChance = 4.5;
  constexpr int kFewSteps = 4;
  const Case c(Small().record({test::cubic_spring(2, 2e11).simulated}, 3));
  Model far = initial_model(c.plant);
  far.theta *= 1.6;
  const Localisation own =
      localise(c.fitter, far, {}, {c.at(Kind::element, test::frame_place(2))}, kFewSteps);
  EXPECT_LT(std::abs(c.beyond_noise(own)), kChance);
}

TEST(Localise, FindsAWrongReadingAtItsAxis) {
  constexpr int kAxis = 1;
  MatrixXd record = Small().record({}, 3);
  record.col(kAxis) *= 1.08;
  const Case c(record);
  const double own = c.localised(c.at(Kind::axis, test::channel_place(kAxis))).ratio;
  for (int axis = 0; axis < 6; ++axis) {
    if (axis == kAxis) continue;
    EXPECT_GT(c.localised(c.at(Kind::axis, test::channel_place(axis))).ratio, own) << axis;
  }
}

TEST(Localise, OneStepRanksTheRightPlaceFirst) {
  const Case c(Small().record({test::cubic_spring(2, 1e11).simulated}, 4));
  const FitResult now = c.fitter.fit(initial_model(c.plant), {}, {});
  ASSERT_TRUE(now.good);
  std::vector<std::vector<CandidatePlace>> lists;
  for (const CandidatePlace& place : c.all) lists.push_back({place});
  const Linearised at =
      c.fitter.linearise(now.model, c.fitter.systems(now.model, now.motion, Forcing::measured));
  const std::vector<Localisation> once = localise_once(c.fitter, at, now.model, lists);
  ASSERT_EQ(once.size(), lists.size());
  std::size_t best = 0;
  for (std::size_t i = 0; i < once.size(); ++i) {
    // An arbitrary signal cannot increase the misfit.
    EXPECT_LT(once[i].misfit, now.cost * 1.001) << i;
    // A crossing can act like each of its frames.
    if (lists[i].front().size() == 1 && once[i].ratio < once[best].ratio) best = i;
  }
  EXPECT_EQ(lists[best].front().kind, Kind::element);
  EXPECT_EQ(lists[best].front().place, test::frame_place(2));
  // The order of the lists does not matter.
  std::vector<std::vector<CandidatePlace>> reversed(lists.rbegin(), lists.rend());
  const std::vector<Localisation> again = localise_once(
      c.fitter, at, now.model, reversed, [](int count, const std::function<void(int)>& work) {
        for (int i = count - 1; i >= 0; --i) work(i);
      });
  for (std::size_t i = 0; i < once.size(); ++i)
    EXPECT_NEAR(again[once.size() - 1 - i].ratio / once[i].ratio, 1, 1e-9);
}

TEST(Localise, FitsEverythingIfAllIsFree) {
  const Case c(Small().record({}, 5));
  std::vector<CandidatePlace> every;
  for (int f = 0; f < 4; ++f) every.push_back(c.at(Kind::element, test::frame_place(f)));
  const Localisation l = localise(c.fitter, initial_model(c.plant), {}, every, kSteps);
  EXPECT_EQ(l.ratio, 1);
  EXPECT_EQ(l.record_ratio, std::vector<double>{1});
  EXPECT_EQ(l.model.theta, c.plant.design);
}

TEST(Localise, FindsNothingForAnInvalidModel) {
  const Case c(Small().record({}, 5));
  Model unknown = initial_model(c.plant);
  unknown.theta[0] = std::numeric_limits<double>::quiet_NaN();
  const Localisation l = localise(c.fitter, unknown, {}, {c.all.front()}, kSteps);
  EXPECT_EQ(l.misfit, 1e300);
  EXPECT_EQ(l.model.theta.size(), 0);
}

}  // namespace localise_test
}  // namespace framewatch::estimator
