// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/fit/fit_columns.h"
#include "estimator/diagnose/fit/normal_equations.h"
#include "estimator/diagnose/locate/localise.h"
#include "estimator/structure/natural_frequencies.h"
#include "tests/estimator/diagnose/exact_record.h"
#include "tests/estimator/diagnose/other_buildings.h"

namespace framewatch::estimator {
namespace large_building_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using test::Small;

constexpr int kStories = 11;
constexpr double kBand = 4;  ///< of the lowest natural frequency

RecordSegment segment_of(const Small& small, const std::vector<Effect>& effects) {
  const MatrixXd record = small.record(effects, 1);
  const double hz = natural_frequencies_hz(small.structure, small.table, small.design).front();
  return make_segment(record, test::kRate_hz, VectorXd::Constant(record.cols(), test::kNoise_mps2),
                      {0.4 * hz, kBand * hz});
}

/// Eleven stories with one record, in the band of the lowest modes.
struct Case {
  Small small = test::tower(kStories);
  Plant plant = small.plant();
  std::vector<RecordSegment> segments;
  Fitter fitter;

  explicit Case(const std::vector<Effect>& effects = {})
      : segments{segment_of(small, effects)}, fitter(plant, segments, {}) {}
  Case(const Case&) = delete;
  Case& operator=(const Case&) = delete;

  Linearised linearised(const Model& model) const {
    return fitter.linearise(model, fitter.systems(model, {}, Forcing::measured));
  }
};

MatrixXd whole_columns(const Linearised& at) {
  MatrixXd out(at.systems[0].residual.size(), at.columns[0].count());
  for (Index u = 0; u < out.cols(); ++u)
    out.col(u) = whole_column(*at.plant, at.systems[0], at.columns[0], u);
  return out;
}

std::vector<Index> all_of(const Linearised& at) {
  std::vector<Index> out(at.unknowns.size());
  std::iota(out.begin(), out.end(), Index{0});
  return out;
}

TEST(LargeBuilding, GradientAndMisfitMatchThoseOfAllBins) {
  constexpr double kRounding = 1e-9;
  const Case c;
  ASSERT_TRUE(c.plant.is_large());
  const Linearised at = c.linearised(initial_model(c.plant));
  const Index count = at.columns[0].count();
  const MatrixXd square = square_of(at, 0, all_of(at));
  ASSERT_EQ(square.cols(), count + 1);
  ASSERT_EQ(ends_of(at, 0), 0);
  const VectorXd expected = whole_columns(at).transpose() * at.systems[0].rest;
  EXPECT_LT((square.col(count).head(count) - expected).norm(), kRounding * expected.norm());
  EXPECT_DOUBLE_EQ(square(count, count), at.systems[0].misfit);
}

TEST(LargeBuilding, SampledBinsRepresentAllBins) {
  constexpr double kShare = 0.15, kOff = 0.35;
  const Case c;
  const Linearised at = c.linearised(initial_model(c.plant));
  const std::vector<SampledBin> sampled = sampled_bins(at, 0);
  const auto bins = static_cast<double>(at.systems[0].bins());
  EXPECT_LT(static_cast<double>(sampled.size()), std::max(129.0, 0.5 * bins));
  double weight = 0;
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    weight += sampled[i].weight;
    const Index before = i > 0 ? sampled[i - 1].bin : -1;
    EXPECT_GT(sampled[i].bin, before);
  }
  EXPECT_NEAR(weight / bins, 1, kShare);
  // The curvature along one unknown after another is about that of all bins.
  const MatrixXd square = square_of(at, 0, all_of(at)), columns = whole_columns(at);
  for (Index u = 0; u < 2 * c.plant.element_count(); ++u)
    EXPECT_NEAR(square(u, u) / columns.col(u).squaredNorm(), 1, kOff) << u;
}

/// With too few bins, the curvature is too small along some directions: the step is too long, and
/// the misfit after it is said to be less than zero.
TEST(LargeBuilding, AStepFromSampledBinsNearlyReachesItsGoal) {
  constexpr double kOff = 0.1;
  const Case c;
  const Linearised at = c.linearised(initial_model(c.plant));
  NormalEquations equations = normal_equations(at);
  const MatrixXd sampled = equations.normal;
  equations.normal.diagonal() += at.prior;
  const VectorXd step = equations.normal.ldlt().solve(at.pull - equations.gradient);
  const double before = at.systems[0].misfit;
  const double said = before + step.dot(sampled * step) + 2 * step.dot(equations.gradient);
  const double after = (at.systems[0].rest + whole_columns(at) * step).squaredNorm();
  EXPECT_GT(said, 0);
  EXPECT_LT(after, kOff * before);
}

/// A resonance narrower than the mean distance of the sampled bins.
TEST(LargeBuilding, SampledBinsIncludeANarrowEffect) {
  constexpr double kOff = 0.1;
  const Case c;
  const double hz =
      1.7 * natural_frequencies_hz(c.small.structure, c.small.table, c.small.design).front();
  const Model model = test::with_effects(
      initial_model(c.plant),
      {test::effect_of(LawForm::resonator, test::node_place(1, kStories), {500, hz, 0.002})});
  const Linearised at = c.linearised(model);
  const Index bins = at.systems[0].bins(), rows = 2 * c.plant.equations();
  const std::vector<SampledBin> sampled = sampled_bins(at, 0);
  EXPECT_LT(static_cast<double>(sampled.size()),
            std::max(129.0, 0.5 * static_cast<double>(bins)) + 24);
  ASSERT_EQ(at.columns[0].effects.cols(), 3);
  for (Index e = 0; e < 3; ++e) {
    const VectorXd column = at.columns[0].effects.col(e);
    double square = 0;
    for (const SampledBin& bin : sampled)
      square += bin.weight * column.segment(rows * bin.bin, rows).squaredNorm();
    EXPECT_NEAR(square / column.squaredNorm(), 1, kOff) << e;
  }
}

TEST(LargeBuilding, AFitReachesTheNoiseFloor) {
  constexpr double kLow = 0.85, kHigh = 1.03;  // fitted values explain a share of the noise
  const Case c;
  FitOptions options;
  options.max_steps = 8;
  const FitResult fit = c.fitter.fit(initial_model(c.plant), {}, options);
  ASSERT_TRUE(fit.good);
  const double ratio = fit.total_misfit() / c.fitter.expected(fit.model);
  EXPECT_GT(ratio, kLow);
  EXPECT_LT(ratio, kHigh);
}

/// The modes of twenty stories take seconds, a run much less.
TEST(LargeBuilding, AStepOfRunsComputesModesOnce) {
  constexpr int kStory = 6, kFrame = 2;
  const Case c;
  EffectPlace place = test::frame_place(kFrame);
  place.story = kStory;
  const Model model = test::with_effects(initial_model(c.plant),
                                         {test::effect_of(LawForm::friction, place, {20e3, 1e-3})});
  std::vector<RunCache> caches(1);
  const FitOptions options = thorough(model, 1);
  const Linearised at = c.fitter.linearise(
      model, c.fitter.systems(model, {}, options.forcing, nullptr, &caches), options, &caches);
  ASSERT_EQ(at.systems.size(), 1U);
  EXPECT_EQ(caches.front().computed(), 1);
  const auto runs = std::count_if(at.unknowns.begin(), at.unknowns.end(),
                                  [&](const Unknown& u) { return moves_run(c.plant, model, u); });
  EXPECT_GT(runs, 3);   // the stiffnesses at the law and next to it, and the law's values
  EXPECT_LT(runs, 10);  // of hundreds of unknowns
}

TEST(LargeBuilding, FindsThePlaceOfAHiddenLaw) {
  constexpr int kStory = 6, kFrame = 2;
  EffectPlace place = test::frame_place(kFrame);
  place.story = kStory;
  const Case c({test::with_values(EffectKind::coulomb_friction, place, {20e3, 1e-3})});
  FitOptions options;
  options.max_steps = 3;
  const FitResult now = c.fitter.fit(initial_model(c.plant), {}, options);
  ASSERT_TRUE(now.good);
  std::vector<std::vector<CandidatePlace>> lists;
  for (const CandidatePlace& candidate : candidate_places_of(c.plant, now.model))
    lists.push_back({candidate});
  const Linearised at =
      c.fitter.linearise(now.model, c.fitter.systems(now.model, now.motion, Forcing::measured));
  const std::vector<Localisation> once = localise_once(c.fitter, at, now.model, lists);
  const auto best = std::min_element(
      once.begin(), once.end(),
      [](const Localisation& a, const Localisation& b) { return a.ratio < b.ratio; });
  EXPECT_EQ(best->candidate_places.front().place, place);
  // It was among those with a conjugate-gradient step.
  const Localisation closer =
      localise_once(c.fitter, at, now.model, {best->candidate_places}).front();
  EXPECT_NEAR(closer.ratio, best->ratio, 1e-9);
}

}  // namespace large_building_test
}  // namespace framewatch::estimator
