#include "estimator/diagnose/trials/catalogue_form.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "estimator/diagnose/model/make_plant.h"
#include "estimator/diagnose/trials/known_effects.h"
#include "tests/estimator/diagnose/hidden_effect.h"
#include "tests/support/example_effects.h"

namespace framewatch::estimator {
namespace catalogue_form_test {

constexpr double kRounding = 1e-9, kRate_hz = 100, kSeconds = 8;
constexpr double kSharp = 40;  // exponent that stands for a corner

Eigen::MatrixXd any_motion(Eigen::Index axes) {
  Random random(31);
  Eigen::MatrixXd out(static_cast<Eigen::Index>(kSeconds * kRate_hz), axes);
  for (double& a : out.reshaped()) a = random.normal();
  return out;
}

/// Plant and one segment of any motion of the two-story model.
struct Scene {
  test::TableModel model = test::table_model();
  Plant plant = *make_plant(model.structure, model.axes, model.theta, kRate_hz);
  std::vector<RecordSegment> segments{
      make_segment(any_motion(plant.axis_count()), kRate_hz,
                   Eigen::VectorXd::Constant(plant.axis_count(), 0.01), {0.5, 12})};

  /// The effect put into a model and read from it again.
  Effect round_trip(const Effect& effect) const {
    Model fitted = initial_model(plant);
    const std::vector<FoundEffect> known = add_known(plant, segments, {effect}, fitted);
    return catalogue_effect(plant, segments, known.front(), fitted);
  }
};

/// All but the level of clipping, which is the record's, and rigid floors' flexibility.
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

TEST(CatalogueForm, APowerBetweenIsTheCataloguesAtTheLargestDeformation) {
  // 700 N at 4 mm, whatever the exponent.
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

TEST(CatalogueForm, RigidHysteresisIsFrictionOfItsYieldForce) {
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

TEST(CatalogueForm, ClippingLevelIsThatOfTheRecordThatIsCutOffFirst) {
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
  // A force that goes on at the record's ends leaks toward low frequencies.
  EXPECT_LE(force.value("low_hz"), kHz);
  EXPECT_NEAR(force.value("high_hz"), kHz, kHzOff);
  EXPECT_NEAR(force.value("rms_n") / (kForce_n / std::sqrt(2)), 1, kSizeOff);
}

}  // namespace catalogue_form_test
}  // namespace framewatch::estimator
