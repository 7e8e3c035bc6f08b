// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/law_tracks.h"
#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/diagnose/locate/locate.h"
#include "tests/estimator/diagnose/exact_record.h"
#include "tests/estimator/diagnose/other_buildings.h"

namespace framewatch::estimator {
namespace candidate_places_test {

using Eigen::Index;
using Eigen::MatrixXcd;
using Kind = CandidatePlace::Kind;
using test::Small;

long count(const std::vector<CandidatePlace>& all, Kind kind) {
  return std::count_if(all.begin(), all.end(),
                       [&](const CandidatePlace& c) { return c.kind == kind; });
}

TEST(CandidatePlaces, ListEveryPlaceOnce) {
  struct Case {
    Plant plant;
    long axes, elements, floors, nodes, links, crossings, rocking;
  };
  // A node of the first story equals its frame; one equation cannot distinguish a reading from a
  // force.
  const Case cases[] = {{Small().plant(), 6, 5, 0, 0, 0, 4, 2},
                        {test::rigid_small().plant(), 6, 4, 1, 0, 0, 4, 2},
                        {test::SingleMass().plant(), 0, 1, 0, 0, 0, 0, 0},
                        {test::three_stories(), 14, 15, 0, 8, 4, 12, 2}};
  for (const Case& c : cases) {
    const std::vector<CandidatePlace> all = candidate_places_of(c.plant, initial_model(c.plant));
    EXPECT_EQ(count(all, Kind::axis), c.axes);
    EXPECT_EQ(count(all, Kind::element), c.elements);
    EXPECT_EQ(count(all, Kind::floor), c.floors);
    EXPECT_EQ(count(all, Kind::node), c.nodes);
    EXPECT_EQ(count(all, Kind::link), c.links);
    EXPECT_EQ(count(all, Kind::crossing), c.crossings);
    EXPECT_EQ(count(all, Kind::rocking), c.rocking);
    for (const CandidatePlace& place : all) {
      EXPECT_EQ(place.size(), place.kind == Kind::crossing ? 2 : 1);
      if (place.kind == Kind::axis) continue;
      EXPECT_EQ(place.directions.rows(), c.plant.equations());
      EXPECT_GT(place.directions.colwise().norm().minCoeff(), 0);
    }
  }
}

TEST(CandidatePlaces, OnlyRockingDependsOnStiffness) {
  const Plant plant = Small().plant();
  Model model = initial_model(plant);
  const std::vector<CandidatePlace> before = candidate_places_of(plant, model);
  model.theta[plant.table.frame_stiffness(1, 0)] *= 2;
  std::vector<CandidatePlace> after = before;
  update_directions(plant, model, after);
  for (std::size_t i = 0; i < before.size(); ++i) {
    const bool moves = before[i].kind == Kind::rocking && before[i].place.direction == Direction::x;
    EXPECT_EQ(after[i].directions != before[i].directions, moves) << i;
  }
}

TEST(CandidatePlaces, HaveAnOrthonormalBasis) {
  constexpr double kRounding = 1e-9;
  const Small small;
  const Plant plant = small.plant();
  const RecordSegment segment = small.segments({small.record({}, 1)}).front();
  const Whitened system =
      whiten(plant, test::true_model(small, plant), segment, 0, Forcing::measured, {}, 2);
  const std::vector<CandidatePlace> all = candidate_places_of(plant, initial_model(plant));
  const auto of = [&](Kind kind) {
    return *std::find_if(all.begin(), all.end(),
                         [&](const CandidatePlace& c) { return c.kind == kind; });
  };
  for (const Index bin : {Index{0}, system.bins() - 1}) {
    const MatrixXcd basis =
        candidate_basis(system, bin, {of(Kind::axis), of(Kind::element), of(Kind::rocking)});
    ASSERT_EQ(basis.cols(), 3);
    EXPECT_LT((basis.adjoint() * basis - MatrixXcd::Identity(3, 3)).norm(), kRounding);
    // Repeating a place adds nothing.
    const MatrixXcd twice = candidate_basis(system, bin, {of(Kind::element), of(Kind::element)});
    EXPECT_LT(std::abs(twice.col(0).norm() - 1), kRounding);
    EXPECT_LT(twice.col(1).norm(), kRounding);
  }
}

Localisation left(Kind kind, double ratio) {
  Localisation out;
  CandidatePlace place;
  place.kind = kind;
  out.candidate_places = {place};
  out.ratio = ratio;
  return out;
}

std::size_t contending(const std::vector<Localisation>& places) {
  return contenders({}, places).size();
}

TEST(Contenders, AreNearTheBestAndLimitedPerKind) {
  const auto e = [](double ratio) { return left(Kind::element, ratio); };
  EXPECT_EQ(contending({}), 0U);
  EXPECT_EQ(contending({e(1)}), 1U);
  EXPECT_EQ(contending({e(1), e(1.1), e(1.5)}), 2U);  // the limit for a good place is 1.2
  EXPECT_EQ(contending({e(3), e(4), e(5), e(6)}), 3U);
  EXPECT_EQ(contending({e(1), e(1), e(1), e(1), e(1)}), 3U);
  EXPECT_EQ(contending({e(1), e(1), e(1), left(Kind::axis, 1), left(Kind::node, 1),
                        left(Kind::crossing, 1)}),
            5U);
  // Bending frames do more than the moment that locates them.
  EXPECT_EQ(contending({e(1), e(1.3), left(Kind::rocking, 1.3), left(Kind::rocking, 1.5)}), 2U);
}

TEST(Contenders, IncludeOneDirectionBesideAMassInBoth) {
  const Plant plant = Small().plant();
  const std::vector<CandidatePlace> all = candidate_places_of(plant, initial_model(plant));
  const auto left_at = [&](Eigen::Index directions, double ratio) {
    Localisation out;
    out.candidate_places = {*std::find_if(all.begin(), all.end(), [&](const CandidatePlace& p) {
      return p.size() == directions && (directions > 1 || p.kind == Kind::element);
    })};
    out.ratio = ratio;
    return out;
  };
  EXPECT_EQ(contending({left_at(2, 3), left_at(1, 40), left_at(1, 500)}), 2U);
  EXPECT_EQ(contending({left_at(2, 1), left_at(1, 40)}), 1U) << "the mass leaves nothing";
}

TEST(Chance, FallsWithTheSquareRootOfTheData) {
  const Small small;
  const Plant plant = small.plant();
  const Eigen::MatrixXd record = small.record({}, 1);
  const std::vector<RecordSegment> one = small.segments({record}),
                                   four = small.segments({record, record, record, record});
  const Model model = initial_model(plant);
  const Fitter of_one(plant, one, {}), of_four(plant, four, {});
  const double bins = static_cast<double>(one.front().bins());
  EXPECT_NEAR(chance_of(of_one, model), SearchSettings().significant / std::sqrt(4 * bins - 8),
              1e-12);
  EXPECT_NEAR(chance_of(of_one, model) / chance_of(of_four, model), 2, 1e-12);
}

}  // namespace candidate_places_test
}  // namespace framewatch::estimator
