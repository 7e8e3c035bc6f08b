// SPDX-License-Identifier: MIT
#include "estimator/diagnose/trials/catalogue_form.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/unknowns.h"
#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/model/make_plant.h"
#include "estimator/diagnose/trials/known_effects.h"
#include "tests/estimator/diagnose/hidden_effect.h"
#include "tests/support/example_effects.h"

namespace framewatch::estimator {
namespace catalogue_form_test {

constexpr double kRounding = 1e-9, kRate_hz = 100, kSeconds = 8;
constexpr double kSharp = 40;  // exponent of a bilinear law

Eigen::MatrixXd any_motion(Eigen::Index axes) {
  Random random(31);
  Eigen::MatrixXd out(static_cast<Eigen::Index>(kSeconds * kRate_hz), axes);
  for (double& a : out.reshaped()) a = random.normal();
  return out;
}

/// Plant and one segment of random motion of the two-story model.
struct Scene {
  test::TableModel model = test::table_model();
  Plant plant = *make_plant(model.structure, model.axes, model.theta, kRate_hz);
  std::vector<RecordSegment> segments{
      make_segment(any_motion(plant.axis_count()), kRate_hz,
                   Eigen::VectorXd::Constant(plant.axis_count(), 0.01), {0.5, 12})};

  /// Adds the effect to a model and reads it back.
  Effect round_trip(const Effect& effect) const {
    Model fitted = initial_model(plant);
    const std::vector<FoundEffect> known = add_known(plant, segments, {effect}, fitted);
    return catalogue_effect(plant, segments, known.front(), fitted);
  }
};

/// Returns all kinds except clipping, whose level is the record's, and the flexibility of rigid
/// floors.
std::vector<EffectKind> kinds_of_a_model() {
  std::vector<EffectKind> out;
  for (const EffectDescription& d : effect_catalogue())
    if (d.kind != EffectKind::clipping && d.kind != EffectKind::floor_flexibility)
      out.push_back(d.kind);
  return out;
}

class RoundTrip : public testing::TestWithParam<EffectKind> {};

TEST_P(RoundTrip, GivesTheSameParameters) {
  const Scene scene;
  for (const double size : {1.0, 0.3}) {
    Effect effect = test::example_effect(GetParam(), scene.model, size);
    // A force has either a frequency or a band.
    if (GetParam() == EffectKind::unmeasured_force) effect.set("rms_n", 0);
    const Effect back = scene.round_trip(effect);
    EXPECT_EQ(back.kind, effect.kind);
    EXPECT_EQ(back.place, effect.place);
    for (const EffectParameter& p : describe(effect.kind).parameters) {
      const bool of_band =
          p.key == "rms_n" || p.key == "low_hz" || p.key == "high_hz" || p.key == "seed";
      if (of_band) continue;
      EXPECT_NEAR(back.value(p.key), effect.value(p.key),
                  kRounding * (1 + std::abs(effect.value(p.key))))
          << p.key;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, RoundTrip, testing::ValuesIn(kinds_of_a_model()),
                         [](const testing::TestParamInfo<EffectKind>& one) {
                           return std::string(name_of(one.param));
                         });

TEST(CatalogueForm, SignsSurviveTheRoundTrip) {
  const Scene scene;
  for (const EffectKind kind :
       {EffectKind::cubic_stiffness, EffectKind::quadratic_stiffness, EffectKind::stiffness_drop,
        EffectKind::extra_mass, EffectKind::gain_error, EffectKind::misalignment,
        EffectKind::time_shift, EffectKind::one_sided_gap, EffectKind::bias_drift}) {
    for (const double sign : {1.0, -1.0}) {
      Effect effect = test::example_effect(kind, scene.model);
      double& signed_value =
          kind == EffectKind::one_sided_gap ? effect.values[2] : effect.values[0];
      signed_value = sign * std::abs(signed_value);
      const Effect back = scene.round_trip(effect);
      const double found = kind == EffectKind::one_sided_gap ? back.values[2] : back.values[0];
      EXPECT_GT(sign * found, 0) << name_of(kind);
    }
  }
}

void expect_round_trip(const Scene& scene, const Effect& effect) {
  const Effect back = scene.round_trip(effect);
  for (const EffectParameter& p : describe(effect.kind).parameters)
    EXPECT_NEAR(back.value(p.key), effect.value(p.key),
                kRounding * (1 + std::abs(effect.value(p.key))))
        << name_of(effect.kind) << " " << p.key;
}

TEST(CatalogueForm, SaturationSurvivesTheRoundTrip) {
  const Scene scene;
  using enum EffectKind;
  for (const EffectKind kind : {cubic_stiffness, quadratic_stiffness, amplitude_dependence})
    for (const double shape : {0.7, 1.0, 4.0}) {
      Effect effect = test::example_effect(kind, scene.model);
      effect.set("saturation_m", 3e-3);
      if (kind == amplitude_dependence)
        effect.set("exponent", shape + 1);
      else
        effect.set("shape", shape);
      SCOPED_TRACE(shape);
      expect_round_trip(scene, effect);
    }
}

TEST(CatalogueForm, SharpnessSurvivesTheRoundTrip) {
  const Scene scene;
  Effect effect = test::example_effect(EffectKind::bilinear_hysteresis, scene.model);
  for (const double sharpness : {0.7, 1.0, 8.0}) {
    effect.set("sharpness", sharpness);
    expect_round_trip(scene, effect);
  }
}

TEST(CatalogueForm, UnlikeYieldingSurvivesTheRoundTrip) {
  const Scene scene;
  Effect effect = test::example_effect(EffectKind::bilinear_hysteresis, scene.model);
  effect.set("spread", 0.3);
  effect.set("asymmetry", -0.4);
  expect_round_trip(scene, effect);
}

TEST(CatalogueForm, PeakOrientedYieldingSurvivesTheRoundTrip) {
  const Scene scene;
  Effect effect = test::example_effect(EffectKind::bilinear_hysteresis, scene.model);
  effect.set("peak_oriented", 1);
  for (const double unloading : {0.0, 0.5}) {
    effect.set("unloading", unloading);
    expect_round_trip(scene, effect);
  }
}

TEST(CatalogueForm, AFrameThatWouldLoseMoreThanAllSaturatesAtASmallerDeformation) {
  const Scene scene;
  Effect effect = test::example_effect(EffectKind::amplitude_dependence, scene.model);
  effect.set("saturation_m", 0.5 * effect.value("at_m"));
  Model fitted = initial_model(scene.plant);
  const FoundEffect found = add_known(scene.plant, scene.segments, {effect}, fitted).front();
  fitted.effects.front().parameters[0].value *= 4;  // loses 1.2 of it at at_m
  const Effect back = catalogue_effect(scene.plant, scene.segments, found, fitted);
  EXPECT_NEAR(back.value("softening"), 1, kRounding);
  EXPECT_LT(back.value("at_m"), effect.value("at_m"));
  const auto share = [](const Effect& e, double d) {
    const double x = d / e.value("at_m"), q = e.value("saturation_m") / e.value("at_m");
    return e.value("softening") * Softening(e.value("exponent"), q).at(x) / x;
  };
  for (const double d : {1e-3, 8e-3, 40e-3})
    EXPECT_NEAR(share(back, d), 4 * share(effect, d), kRounding);
}

TEST(CatalogueForm, AFractionalPowerMatchesTheCatalogueAtTheLargestDeformation) {
  // 700 N at 4 mm, for any exponent.
  const Scene scene;
  constexpr double kForce_n = 700, kPeak_m = 4e-3;
  for (const EffectKind kind : {EffectKind::cubic_stiffness, EffectKind::quadratic_stiffness}) {
    Model fitted = initial_model(scene.plant);
    FoundEffect found =
        add_known(scene.plant, scene.segments, {test::example_effect(kind, scene.model)}, fitted)
            .front();
    ModelEffect& law = fitted.effects.front();
    law.deformation = kPeak_m;
    law.parameters[0].value = kForce_n;
    law.parameters[1].value = 2.4;
    const double exponent = kind == EffectKind::cubic_stiffness ? 3 : 2;
    const Effect back = catalogue_effect(scene.plant, scene.segments, found, fitted);
    EXPECT_NEAR(back.values[0] * std::pow(kPeak_m, exponent), kForce_n, kRounding * kForce_n);
  }
}

TEST(CatalogueForm, RigidHysteresisBecomesFrictionOfItsYieldForce) {
  const Scene scene;
  Model fitted = initial_model(scene.plant);
  const Effect corner = test::example_effect(EffectKind::bilinear_hysteresis, scene.model);
  FoundEffect found = add_known(scene.plant, scene.segments, {corner}, fitted).front();
  EXPECT_DOUBLE_EQ(fitted.effects.front().parameters[2].plain(), kSharp);
  found.chosen.kind = EffectKind::coulomb_friction;
  const Effect friction = catalogue_effect(scene.plant, scene.segments, found, fitted);
  EXPECT_NEAR(friction.value("fc_n"), corner.value("kh_npm") * corner.value("dy_m"), kRounding);
  EXPECT_GT(friction.value("v0_mps"), 0);
}

TEST(CatalogueForm, NoChangeBeginsBeforeTheRecord) {
  const Scene scene;
  for (const EffectKind kind : {EffectKind::stiffness_drop, EffectKind::stiffness_drift}) {
    Model fitted = initial_model(scene.plant);
    const FoundEffect found =
        add_known(scene.plant, scene.segments, {test::example_effect(kind, scene.model)}, fitted)
            .front();
    fitted.effects.front().record_parameters[0][0].value = -1.5;
    const Effect back = catalogue_effect(scene.plant, scene.segments, found, fitted);
    EXPECT_DOUBLE_EQ(back.value(kind == EffectKind::stiffness_drop ? "at_s" : "from_s"), 0);
  }
}

TEST(CatalogueForm, ClippingLevelIsTheLowestOfAllRecords) {
  const test::Recorded recorded(test::records_with({}, {1, 2}));
  FoundEffect found;
  found.chosen.kind = EffectKind::clipping;
  found.chosen.place = test::at_channel(1);
  found.index = 0;
  Model fitted = initial_model(recorded.plant);
  fitted.effects.push_back({LawForm::clipped, found.chosen.place, {}, {}, 1, 1, {}});
  double least = 1e300;
  for (const RecordSegment& s : recorded.segments)
    least = std::min(least, 0.5 * (s.accel.col(1).maxCoeff() - s.accel.col(1).minCoeff()));
  EXPECT_DOUBLE_EQ(
      catalogue_effect(recorded.plant, recorded.segments, found, fitted).value("level_mps2"),
      least);
}

TEST(CatalogueForm, BandAndSizeOfAForceAreReadFromTheRecord) {
  constexpr double kForce_n = 4000, kHz = 3.3, kHzOff = 0.3, kSizeOff = 0.15;
  const test::Recorded recorded(test::records_with({test::effect_of(
      EffectKind::unmeasured_force, test::at_node(2), {kForce_n, kHz, 0, 0, 0.1, 10, 1, 0})}));
  FoundEffect found;
  found.chosen.kind = EffectKind::unmeasured_force;
  found.chosen.place = test::at_node(2);
  found.index = 0;
  ModelEffect any;
  any.form = LawForm::broadband;
  any.place = found.chosen.place;
  Model fitted = initial_model(recorded.plant);
  fitted.theta = recorded.small.truth;
  fitted.effects.push_back(any);
  const Effect force = catalogue_effect(recorded.plant, recorded.segments, found, fitted);
  // A force that continues beyond the record's ends leaks toward low frequencies.
  EXPECT_LE(force.value("low_hz"), kHz);
  EXPECT_NEAR(force.value("high_hz"), kHz, kHzOff);
  EXPECT_NEAR(force.value("rms_n") / (kForce_n / std::sqrt(2)), 1, kSizeOff);
}

using test::Recorded;

constexpr double kCurvatureOff = 0.1;  // of a cost that is only nearly a parabola
constexpr double kSpreadOff =
    0.35;  // three standard deviations of a standard deviation from 40 fits
constexpr double kScaleOff = 0.1;
constexpr Tolerances kExact{0, 0, 0};

/// A fitted model with these effects, and their errors.
struct FittedEffects {
  FitResult fit;
  std::vector<FoundEffect> effects;

  FittedEffects(const Fitter& fitter, const std::vector<Effect>& known) {
    Model start = initial_model(fitter.plant());
    effects = add_known(fitter.plant(), fitter.segments(), known, start);
    fit = fitter.fit(start, {}, thorough(start, 12));
    set_errors(fitter, fit.model, fit.motion, effects);
  }
};

TEST(ParameterErrors, CostRisesByHalfTheSquareOfTheDeviations) {
  constexpr double kDeviations = 2;
  const Effect mass = test::effect_of(EffectKind::extra_mass, test::at_crossing(1), {3000});
  const Recorded recorded(test::records_with({mass}));
  const FittedEffects fitted(recorded.fitter, {mass});
  ASSERT_EQ(fitted.effects[0].std_error.size(), 1U);
  for (const double side : {-1.0, 1.0}) {
    Model held = fitted.fit.model;
    LawParameter& parameter = held.effects[0].parameters[0];
    parameter.value += side * kDeviations * fitted.effects[0].std_error[0];
    parameter.free = false;
    const FitResult others = recorded.fitter.fit(held, {}, thorough(held, 12));
    EXPECT_NEAR((others.cost - fitted.fit.cost) / (0.5 * kDeviations * kDeviations), 1,
                kCurvatureOff);
  }
}

TEST(ParameterErrors, MatchTheScatterOverOtherNoise) {
  constexpr int kFits = 40;
  constexpr double kNoise_mps2 = 0.03;
  const Effect gain = test::effect_of(EffectKind::gain_error, test::at_channel(1), {0.0});
  const Effect mass = test::effect_of(EffectKind::extra_mass, test::at_crossing(1), {3000});
  const test::Small small;
  const Plant plant = small.plant();
  const Eigen::MatrixXd exact = small.record({mass}, 1);
  const Eigen::VectorXd w = small.segments({exact}).front().w;
  const Band band{w[0] / (2 * M_PI), w[w.size() - 1] / (2 * M_PI)};
  Random random(77);
  Eigen::ArrayXXd found(kFits, 2), told(kFits, 2);
  for (int i = 0; i < kFits; ++i) {
    Eigen::MatrixXd noisy = exact;
    for (double& a : noisy.reshaped()) a += kNoise_mps2 * random.normal();
    const std::vector<RecordSegment> segments{make_segment(
        noisy, test::kRate_hz, Eigen::VectorXd::Constant(noisy.cols(), kNoise_mps2), band)};
    const FittedEffects fitted(Fitter(plant, segments, kExact), {gain, mass});
    found.row(i) << fitted.fit.model.gain[1], fitted.fit.model.effects[0].parameters[0].plain();
    told.row(i) << fitted.effects[0].std_error[0], fitted.effects[1].std_error[0];
  }
  for (Eigen::Index k = 0; k < 2; ++k) {
    const Eigen::ArrayXd off = found.col(k) - found.col(k).mean();
    EXPECT_NEAR(std::sqrt(off.square().sum() / (kFits - 1)) / told.col(k).mean(), 1, kSpreadOff)
        << k;
  }
}

TEST(ParameterErrors, GrowWithTheMisfitBeyondTheNoise) {
  constexpr double kLess = 9;
  const Effect mass = test::effect_of(EffectKind::extra_mass, test::at_crossing(1), {3000});
  const Recorded recorded(test::records_with({mass}), kExact);
  std::vector<RecordSegment> believed_quiet = recorded.segments;
  for (RecordSegment& s : believed_quiet) s.variance /= kLess;
  const double told = FittedEffects(recorded.fitter, {mass}).effects[0].std_error[0];
  const double of_quiet =
      FittedEffects(Fitter(recorded.plant, believed_quiet, kExact), {mass}).effects[0].std_error[0];
  EXPECT_NEAR(of_quiet / told, 1, kScaleOff);
}

TEST(ParameterErrors, HaveTheCataloguesUnits) {
  // The angle is fitted in rad and given in degrees.
  EffectPlace pair = test::at_channel(0);
  pair.kind = PlaceKind::channel_pair;
  pair.with_channel = 2;
  const Effect angle = test::effect_of(EffectKind::misalignment, pair, {4});
  std::vector<Eigen::MatrixXd> records = test::records_with({});
  const double turn = 4 * M_PI / 180;
  records[0].col(0) =
      (std::cos(turn) * records[0].col(0) + std::sin(turn) * records[0].col(2)).eval();
  const Recorded recorded(records);
  const FittedEffects fitted(recorded.fitter, {angle});
  const double error_deg = fitted.effects[0].std_error[0];
  Model held = fitted.fit.model;
  held.effects[0].parameters[0].value += 2 * error_deg * M_PI / 180;
  held.effects[0].parameters[0].free = false;
  const FitResult others = recorded.fitter.fit(held, {}, thorough(held, 12));
  EXPECT_NEAR((others.cost - fitted.fit.cost) / 2, 1, kCurvatureOff);
}

TEST(ParameterErrors, LeaveOutARamp) {
  const Recorded recorded(test::records_with({}));
  const FittedEffects fitted(
      recorded.fitter, {test::effect_of(EffectKind::bias_drift, test::at_channel(1), {0.02, 1})});
  EXPECT_TRUE(fitted.effects[0].std_error.empty());
}

}  // namespace catalogue_form_test

}  // namespace framewatch::estimator
