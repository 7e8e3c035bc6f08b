// SPDX-License-Identifier: MIT
#include "estimator/diagnose/model/free_run.h"

#include <gtest/gtest.h>

#include "tests/estimator/diagnose/exact_record.h"

namespace framewatch::estimator {
namespace free_run_test {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
using test::effect_of;
using test::EffectTwins;
using test::Small;
using test::with_values;

constexpr int kRatio = 4;
constexpr int kWatched = 2;  // frame whose deformation is compared

/// Returns a law without a force. It only shows the motion of its element.
ModelEffect onlooker() {
  return effect_of(LawForm::power, test::frame_place(kWatched), {0, 1});
}

/// Returns the band of the second derivative of a track's deformation, from its rate.
VectorXcd acceleration_of(const LawTrack& track, const RecordSegment& segment) {
  const double per_s = segment.rate_hz * kRatio / 12;
  VectorXd out = VectorXd::Zero(track.v.size());
  for (Index i = 2; i + 2 < out.size(); ++i)
    out[i] = per_s * (8 * (track.v[i + 1] - track.v[i - 1]) - track.v[i + 2] + track.v[i - 2]);
  return band_of(out, segment, kRatio);
}

RecordSegment segment_of(const Small& small, const MatrixXd& record, Index lead) {
  const std::vector<double> hz = natural_frequencies_hz(small.structure, small.table, small.truth);
  return make_segment(record, test::kRate_hz, VectorXd::Constant(6, test::kNoise_mps2),
                      {0.4 * hz.front(), 1.6 * hz.back()}, {}, lead);
}

/// Returns the relative distance of the run's deformation from the recorded one, at the watched
/// frame.
double miss(const Small& small, const MatrixXd& record, const Model& with, Index lead = 0) {
  const Plant plant = small.plant();
  const RecordSegment segment = segment_of(small, record, lead);
  const FreeRun run = free_run(plant, test::with_effects(with, {onlooker()}), segment, 0, kRatio);
  if (!run.good) return 1e300;
  const VectorXcd measured =
      (plant.building.sense.row(plant.table.frame_stiffness(1, kWatched)) * segment.spectrum)
          .transpose();
  return (acceleration_of(run.tracks.back(), segment) - measured).norm() / measured.norm();
}

TEST(FreeRun, ReproducesTheMotionOfALinearBuilding) {
  constexpr double kTolerance = 5e-3, kShows = 0.05;
  const Small small;
  const Model model = test::true_model(small, small.plant());
  const MatrixXd record = test::exact_record(small, {}, 1);
  EXPECT_LT(miss(small, record, model), kTolerance);
  Model softer = model;
  softer.theta[small.table.frame_stiffness(1, kWatched)] *= 0.97;
  EXPECT_GT(miss(small, record, softer), kShows);
}

std::vector<EffectTwins> all_twins();

class FreeRunWith : public testing::TestWithParam<std::size_t> {};

TEST_P(FreeRunWith, AnEffectMatchesTheSimulator) {
  constexpr double kTolerance = 0.02, kShows = 0.06;
  const Small small;
  const Model model = test::true_model(small, small.plant());
  const EffectTwins twins = all_twins()[GetParam()];
  const MatrixXd record = test::exact_record(small, {twins.simulated}, 2);
  EXPECT_LT(miss(small, record, test::with_effects(model, {twins.modelled})), kTolerance);
  EXPECT_GT(miss(small, record, model), kShows);
}

std::vector<EffectTwins> all_twins() {
  using enum EffectKind;
  const auto frame = test::frame_place(kWatched);
  const auto ground = test::pair_place(kWatched);
  const auto building = test::building_place(Direction::y);
  const auto node = test::node_place(kWatched);
  EffectPlace mode;
  mode.kind = PlaceKind::mode;
  mode.mode = 2;
  const auto twin = [](EffectKind kind, LawForm form, const EffectPlace& place,
                       const std::vector<double>& simulated, const std::vector<double>& modelled,
                       const std::vector<double>& of_record = {}) {
    return EffectTwins{with_values(kind, place, simulated),
                       effect_of(form, place, modelled, of_record)};
  };
  return {
      test::cubic_spring(kWatched, 2e11),
      test::extra_mass(1, 6000),
      twin(bilinear_hysteresis, LawForm::hysteresis, frame, {4e6, 2e-3}, {4e6, 2e-3, 40, 0.5}),
      twin(coulomb_friction, LawForm::friction, frame, {3000, 2e-3}, {3000, 2e-3}),
      twin(quadratic_damping, LawForm::power_damping, frame, {4e6}, {4e6, 2}),
      twin(two_sided_gap, LawForm::gap_both, frame, {6e6, 3e-3}, {6e6, 3e-3}),
      twin(stiffness_drift, LawForm::changing, frame, {-6e5, 4, 10}, {-6e5}, {4, 10}),
      twin(added_spring, LawForm::spring, ground, {9e5}, {9e5}),
      twin(added_damper, LawForm::damper, ground, {8e4}, {8e4}),
      twin(modal_damping, LawForm::modal_damping, mode, {0.02}, {0.02}),
      twin(base_rocking, LawForm::rocking, building, {2e9}, {1 / 2e9}),
      twin(frame_bending, LawForm::bending, building, {1e9}, {1 / 1e9}),
      twin(tuned_mass_damper, LawForm::resonator, node, {2500, 2.4, 0.08}, {2500, 2.4, 0.08}),
  };
}

INSTANTIATE_TEST_SUITE_P(Catalogue, FreeRunWith, testing::Range(std::size_t{0}, all_twins().size()),
                         [](const testing::TestParamInfo<std::size_t>& one) {
                           return std::string(name_of(all_twins()[one.param].simulated.kind));
                         });

TEST(FreeRun, AHarmonicForceActsFromItsOnset) {
  constexpr double kTolerance = 0.02, kHz = 3.1, kForce_n = 6000, kFrom_s = 5;
  const auto node = test::node_place(kWatched);
  Effect force = make_effect(EffectKind::unmeasured_force, node);
  force.set("amplitude_n", kForce_n);
  force.set("frequency_hz", kHz);
  force.set("rms_n", 0);
  force.set("from_s", kFrom_s);
  const Small small;
  ModelEffect harmonic = effect_of(LawForm::harmonic, node, {kHz}, {0, kForce_n});
  harmonic.onset_s = {kFrom_s};
  const Model model = test::true_model(small, small.plant());
  const MatrixXd record = test::exact_record(small, {force}, 3);
  EXPECT_LT(miss(small, record, test::with_effects(model, {harmonic})), kTolerance);
  harmonic.onset_s = {0};
  EXPECT_GT(miss(small, record, test::with_effects(model, {harmonic})), 2 * kTolerance);
}

/// A yielding frame of a strongly driven building.
struct Yielding {
  Small small;
  Plant plant = small.plant();
  RecordSegment segment = segment_of(small, test::exact_record(small, {}, 2), 0);
  Model model = test::with_effects(
      test::true_model(small, plant),
      {effect_of(LawForm::hysteresis, test::frame_place(kWatched), {2e6, 5e-4, 2, 0.5})});

  FreeRun run(const Model& of, RunCache* cache,
              const std::vector<SmallSpring>& springs = {}) const {
    return free_run(plant, of, segment, 0, kRatio, cache, springs);
  }
};

TEST(FreeRun, ASmallSpringActsLikeAChangeOfStiffness) {
  constexpr double kChange = 1e-3, kTolerance = 0.01;
  const Yielding y;
  const VectorXd before = y.run(y.model, nullptr).tracks.front().d;
  for (const int frame : {kWatched, kWatched + 1}) {
    const Index element = y.small.table.frame_stiffness(1, frame);
    const double change = kChange * y.model.theta[element];
    Model stiffer = y.model;
    stiffer.theta[element] += change;
    const VectorXd expected = y.run(stiffer, nullptr).tracks.front().d - before;
    const VectorXd found = y.run(y.model, nullptr, {{element, change}}).tracks.front().d - before;
    EXPECT_GT(expected.norm(), 0);
    EXPECT_LT((found - expected).norm(), kTolerance * expected.norm()) << frame;
  }
}

TEST(FreeRun, FromACacheIsTheSame) {
  const Yielding y;
  RunCache cache;
  Model other = y.model, softer = y.model, late = y.model;
  other.effects[0].parameters[1].value *= 0.7;
  softer.theta[y.small.table.frame_stiffness(1, 0)] *= 0.9;
  late.clock_s.setConstant(1e-3);
  for (const Model& model : {y.model, other, softer, late, y.model}) {
    const FreeRun cached = y.run(model, &cache), own = y.run(model, nullptr);
    ASSERT_TRUE(cached.good);
    EXPECT_EQ(cached.tracks.front().d, own.tracks.front().d);
    EXPECT_EQ(cached.tracks.front().force, own.tracks.front().force);
  }
}

TEST(FreeRun, RemovesGainAndDelayOfTheBase) {
  constexpr double kTolerance = 2e-3, kGain = 0.1;
  constexpr Index kLate = 2;  // samples
  const Small small;
  const Plant plant = small.plant();
  const MatrixXd record = test::exact_record(small, {}, 4);
  Model model = test::with_effects(test::true_model(small, plant), {onlooker()});
  const auto deformation = [&](const MatrixXd& read) {
    return free_run(plant, model, segment_of(small, read, 0), 0, kRatio).tracks.front().d;
  };
  const VectorXd expected = deformation(record);
  MatrixXd read = record;
  for (const Index base : {4, 5}) {
    read.col(base).tail(record.rows() - kLate) =
        (1 + kGain) * record.col(base).head(record.rows() - kLate);
    model.gain[base] = kGain;
    model.clock_s[base] = kLate / test::kRate_hz;
  }
  EXPECT_LT((deformation(read) - expected).norm(), kTolerance * expected.norm());
  model.clock_s.setZero();
  EXPECT_GT((deformation(read) - expected).norm(), kGain * expected.norm());
}

TEST(FreeRun, ALeadProvidesTheInitialMotionOfARecord) {
  constexpr double kTolerance = 0.02;
  const Small small;
  const EffectTwins twins = test::cubic_spring(kWatched, 2e11);
  const Model model = test::with_effects(test::true_model(small, small.plant()), {twins.modelled});
  const MatrixXd record = test::exact_record(small, {twins.simulated}, 5);
  constexpr Index kLead = 300;
  EXPECT_LT(miss(small, record, model, kLead), kTolerance);
  EXPECT_GT(miss(small, record.bottomRows(record.rows() - kLead), model), 2 * kTolerance);
}

TEST(FreeRun, IsNotGoodIfItDiverges) {
  const Small small;
  const MatrixXd record = test::exact_record(small, {}, 6);
  const Model model = test::true_model(small, small.plant());
  const ModelEffect pushes =
      effect_of(LawForm::power, test::frame_place(kWatched), {-5 * small.truth[0], 1});
  EXPECT_EQ(miss(small, record, test::with_effects(model, {pushes})), 1e300);
  Model drives = model;
  drives.theta.tail(5) *= -50;
  EXPECT_EQ(miss(small, record, drives), 1e300);
  Model nothing = model;
  nothing.theta[0] = std::nan("");
  EXPECT_EQ(miss(small, record, nothing), 1e300);
}

}  // namespace free_run_test
}  // namespace framewatch::estimator
