#include "estimator/diagnose/trials/catalogue_form.h"

#include <cmath>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/unknowns.h"
#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/trials/known_effects.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace parameter_errors_test {

using test::Recorded;

constexpr double kCurvatureOff = 0.1;  // of a cost that is not quite a parabola
constexpr double kSpreadOff = 0.35;    // three deviations of a deviation of 40 fits
constexpr double kScaleOff = 0.1;
constexpr Tolerances kExact{0, 0, 0};

/// A model with these effects, fitted, and the errors of them.
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

TEST(ParameterErrors, FitsOfRecordsWithOtherNoiseSpreadAsMuch) {
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

TEST(ParameterErrors, MoreMisfitThanNoiseMakesThemAsMuchLarger) {
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

TEST(ParameterErrors, AreOfTheCataloguesUnits) {
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

TEST(ParameterErrors, ARampIsLeftAlone) {
  const Recorded recorded(test::records_with({}));
  const FittedEffects fitted(
      recorded.fitter, {test::effect_of(EffectKind::bias_drift, test::at_channel(1), {0.02, 1})});
  EXPECT_TRUE(fitted.effects[0].std_error.empty());
}

}  // namespace parameter_errors_test
}  // namespace framewatch::estimator
