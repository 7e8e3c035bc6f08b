// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/diagnosis.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/hidden_effect.h"
#include "tests/estimator/diagnose/other_buildings.h"

namespace framewatch::estimator {
namespace diagnosis_test {

using test::Recorded;

Localisation at(const EffectPlace& place, double ratio) {
  Localisation out;
  out.candidate_places.emplace_back();
  out.candidate_places.front().place = place;
  out.ratio = ratio;
  return out;
}

TEST(Map, ListsEveryPlaceOnceBestFirst) {
  Located located;
  located.places = {at(test::in_frame(1), 1.1), at(test::in_frame(0), 3)};
  // After one step: the same places with larger ratios, and others.
  located.once = {at(test::in_frame(0), 2.5), at(test::in_frame(1), 1.6),
                  at(test::in_frame(2), 1.4), at(test::at_channel(1), 9),
                  at(test::in_frame(3), 1.4)};
  const std::vector<WhereEntry> map = map_of(located);
  const EffectPlace places[] = {test::in_frame(1), test::in_frame(2), test::in_frame(3),
                                test::in_frame(0), test::at_channel(1)};
  const double ratios[] = {1.1, 1.4, 1.4, 3, 9};
  ASSERT_EQ(map.size(), std::size(places));
  for (std::size_t i = 0; i < map.size(); ++i) {
    EXPECT_EQ(map[i].place, places[i]) << i;
    EXPECT_DOUBLE_EQ(map[i].ratio, ratios[i]) << i;
    EXPECT_DOUBLE_EQ(map[i].peak, 0) << "a map has no signals";
  }
  EXPECT_TRUE(map_of({}).empty());
}

TEST(Where, GivesTimeFrequencyAndSize) {
  constexpr double kSize_mps2 = 1, kHz = 3.3, kFrom_s = 7, kTo_s = 15;
  constexpr double kHzOff = 0.3, kTimeOff_s = 1.5, kSizeOff = 0.2;
  constexpr int kChannel = 1;
  // A burst in the reading of one axis, most of it in the second record.
  std::vector<Eigen::MatrixXd> records = test::records_with({}, {1, 2});
  for (const std::size_t record : {0U, 1U})
    for (Eigen::Index i = 0; i < records[record].rows(); ++i) {
      const double t = static_cast<double>(i) / test::kRate_hz;
      const double share = std::clamp((t - kFrom_s) / (kTo_s - kFrom_s), 0.0, 1.0);
      records[record](i, kChannel) += (record == 0 ? 0.2 : 1.0) * kSize_mps2 *
                                      std::sin(M_PI * share) * std::sin(2 * M_PI * kHz * t);
    }
  const Recorded recorded(records);
  const EffectPlace place = test::at_channel(kChannel);
  const WhereEntry entry = where_of(recorded.fitter, {recorded.freed(place)}).front();
  EXPECT_EQ(entry.place, place);
  EXPECT_EQ(entry.record, 1U);
  // Nine tenths of its energy: not the ends.
  EXPECT_GT(entry.from_s, kFrom_s);
  EXPECT_LT(entry.from_s, kFrom_s + 2 * kTimeOff_s);
  EXPECT_LT(entry.to_s, kTo_s);
  EXPECT_GT(entry.to_s, kTo_s - 2 * kTimeOff_s);
  EXPECT_NEAR(entry.low_hz, kHz, kHzOff);
  EXPECT_NEAR(entry.high_hz, kHz, kHzOff);
  EXPECT_NEAR(entry.peak / kSize_mps2, 1, kSizeOff);
}

TEST(Where, DescribesOnlyTheLikeliestPlaces) {
  constexpr std::size_t kDescribed = 3;
  const Recorded recorded(test::records_with({test::effect_of(
      EffectKind::unmeasured_force, test::at_node(2), {4000, 3.3, 0, 0, 0.1, 10, 1, 0})}));
  std::vector<Localisation> places;
  for (const int frame : {2, 0, 1, 3}) places.push_back(recorded.freed(test::in_frame(frame)));
  const std::vector<WhereEntry> where = where_of(recorded.fitter, places);
  ASSERT_EQ(where.size(), places.size());
  for (std::size_t i = 0; i < where.size(); ++i) {
    EXPECT_DOUBLE_EQ(where[i].ratio, places[i].ratio);
    EXPECT_EQ(where[i].place, places[i].candidate_places.front().place);
    EXPECT_EQ(where[i].peak > 0, i < kDescribed) << i;
  }
}

/// Returns the place of the upper of two floors along the first frame, with an effect there.
WhereEntry of_upper_floor(EffectKind kind, PlaceKind at, std::initializer_list<double> values) {
  const test::Small small = test::tower(2);
  EffectPlace place = test::at_node(0);
  place.story = 2;
  const EffectPlace node = place;
  place.kind = at;
  const Plant plant = small.plant();
  const auto segments = small.segments({small.record({test::effect_of(kind, place, values)}, 1)});
  const Fitter fitter(plant, segments, {});
  const Model start = fitter.fit(initial_model(plant), {}, {}).model;
  for (const CandidatePlace& candidate : candidate_places_of(plant, start))
    if (candidate.place == node)
      return where_of(fitter, {localise(fitter, start, {}, {candidate}, 6)}).front();
  return {};
}

TEST(Where, GivesAFloorsKindOfForceIfItFollowsTheMotion) {
  const WhereEntry stop =
      of_upper_floor(EffectKind::one_sided_gap, PlaceKind::node_pair, {2e7, 0.01, 1, 0});
  ASSERT_TRUE(stop.kind);
  EXPECT_STREQ(law_kind_word(stop.kind->kind), "impact");
  const WhereEntry oscillator =
      of_upper_floor(EffectKind::tuned_mass_damper, PlaceKind::node, {2000, 2.1, 0.05});
  ASSERT_GT(oscillator.peak, 0);
  EXPECT_FALSE(oscillator.kind) << "it does not follow the floor's motion";
}

}  // namespace diagnosis_test
}  // namespace framewatch::estimator
