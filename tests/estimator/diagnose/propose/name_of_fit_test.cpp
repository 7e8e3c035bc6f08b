// SPDX-License-Identifier: MIT
#include <cmath>
#include <initializer_list>

#include <gtest/gtest.h>

#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/propose/name_of_fit.h"
#include "estimator/diagnose/propose/needed_signal.h"
#include "estimator/diagnose/propose/propose.h"

namespace framewatch::estimator {
namespace name_of_fit_test {

// Thresholds of the names.
constexpr double kExponent = 2.45;     // cubic above
constexpr double kRigidShare = 0.02;   // of the peak deformation: friction below
constexpr double kCorner = 20;         // exponent of hysteresis: bilinear above
constexpr double kSuddenShare = 0.06;  // of the record: a drop below
constexpr double kNear = 1e-3;         // on either side, relative
constexpr double kPeak_m = 0.012, kSeconds = 30, kRate_hz = 10;

RecordSegment half_minute() {
  RecordSegment out;
  out.rate_hz = kRate_hz;
  out.accel.setZero(static_cast<Eigen::Index>(kSeconds * kRate_hz) + 1, 1);
  return out;
}

ModelEffect effect_with(LawForm form, const std::vector<double>& values) {
  ModelEffect out;
  out.form = form;
  out.deformation = kPeak_m;
  for (const double value : values) out.parameters.push_back(linear_parameter(value, 1));
  return out;
}

std::string_view name(const ModelEffect& effect) {
  return name_of(name_of_fit({}, effect, half_minute()));
}

TEST(NameOfFit, ExponentDistinguishesQuadraticFromCubic) {
  EXPECT_EQ(name(effect_with(LawForm::power, {1, 1.2})), "quadratic_stiffness");
  EXPECT_EQ(name(effect_with(LawForm::power, {1, kExponent * (1 - kNear)})), "quadratic_stiffness");
  EXPECT_EQ(name(effect_with(LawForm::power, {1, kExponent * (1 + kNear)})), "cubic_stiffness");
  EXPECT_EQ(name(effect_with(LawForm::power, {-1, 9})), "cubic_stiffness");
}

TEST(NameOfFit, ASaturatingSpringHasTheNameOfTheNearestPower) {
  const auto saturating = [](double d0_share, double shape) {
    return name(effect_with(LawForm::saturating, {-1, d0_share * kPeak_m, shape}));
  };
  EXPECT_EQ(saturating(10, 1), "quadratic_stiffness");
  EXPECT_EQ(saturating(10, 2), "cubic_stiffness");
  EXPECT_EQ(saturating(1, 1), "quadratic_stiffness");
  EXPECT_EQ(saturating(0.1, 1), "quadratic_stiffness");
}

TEST(NameOfFit, TwoSlopesAreASaturatingSpring) {
  ModelEffect contact = effect_with(LawForm::gap_both, {-1e6, 0.4 * kPeak_m, 0});
  const ModelEffect spring = two_slopes(contact);
  EXPECT_EQ(name(spring), name(contact));
  for (const double share : {-1.0, 0.2, 0.7}) {
    const double d = share * kPeak_m;
    EXPECT_NEAR(LawMotion(spring.law(0)).force(d, 0, 0), LawMotion(contact.law(0)).force(d, 0, 0),
                0.02 * 1e6 * kPeak_m);
  }
}

TEST(NameOfFit, YieldAndSharpnessDistinguishHysteresis) {
  const auto hysteresis = [](double yield_share, double exponent) {
    return name(effect_with(LawForm::hysteresis, {1e6, yield_share * kPeak_m, exponent, 0.5}));
  };
  EXPECT_EQ(hysteresis(0.3, 2), "bouc_wen");
  EXPECT_EQ(hysteresis(0.3, kCorner * (1 - kNear)), "bouc_wen");
  EXPECT_EQ(hysteresis(0.3, kCorner * (1 + kNear)), "bilinear_hysteresis");
  EXPECT_EQ(hysteresis(kRigidShare * (1 + kNear), 40), "bilinear_hysteresis");
  // A law that yields at once is friction, however sharp it is.
  EXPECT_EQ(hysteresis(kRigidShare * (1 - kNear), 40), "coulomb_friction");
  EXPECT_EQ(hysteresis(kRigidShare * (1 - kNear), 2), "coulomb_friction");
}

TEST(NameOfFit, YieldingIsFrictionIfItYieldsAtOnce) {
  for (const LawForm form : {LawForm::masing, LawForm::peak_oriented}) {
    const auto yielding = [form](double yield_share) {
      return name(effect_with(form, {1e6, yield_share * kPeak_m, 1}));
    };
    EXPECT_EQ(yielding(0.3), "bilinear_hysteresis");
    EXPECT_EQ(yielding(kRigidShare * (1 + kNear)), "bilinear_hysteresis");
    EXPECT_EQ(yielding(kRigidShare * (1 - kNear)), "coulomb_friction");
  }
}

TEST(NameOfFit, IgnoresASlipZoneAsWideAsTheLoop) {
  const auto pinched = [](double yield_share, double width, double work = 0) {
    return effect_with(LawForm::pinched,
                       {1e6, yield_share * kPeak_m, 2, 0.5, 0.5, width, 0, work, 0, 0});
  };
  EXPECT_EQ(name(pinched(0.3, 0.3)), "pinching");
  EXPECT_EQ(name(pinched(0.3, 2)), "bouc_wen");
  EXPECT_EQ(name(pinched(0.3, 2, 4)), "pinching") << "it opens with work";
  // With half the stiffness it yields at twice the deformation.
  EXPECT_EQ(name(pinched(0.4 * kRigidShare, 2)), "coulomb_friction");
  EXPECT_EQ(name(pinched(0.6 * kRigidShare, 2)), "bouc_wen");
  const ModelEffect plain = without_slip(pinched(0.3, 2));
  EXPECT_DOUBLE_EQ(plain.parameters[0].plain(), 5e5);
  EXPECT_DOUBLE_EQ(plain.parameters[1].plain(), 0.6 * kPeak_m);
  EXPECT_EQ(plain.parameters.size(), 6U);
}

TEST(NameOfFit, ReadsAYieldFromItsLogarithm) {
  ModelEffect effect = effect_with(LawForm::hysteresis, {1e6, 0, 2, 0.5});
  effect.parameters[1] = logarithmic_parameter(0.3 * kPeak_m, 1e-9, 1);
  EXPECT_EQ(name(effect), "bouc_wen");
  effect.parameters[1] = logarithmic_parameter(0.5 * kRigidShare * kPeak_m, 1e-9, 1);
  EXPECT_EQ(name(effect), "coulomb_friction");
}

TEST(NameOfFit, DurationDistinguishesDropFromDrift) {
  const auto change = [](std::initializer_list<double> durations_s) {
    ModelEffect out = effect_with(LawForm::changing, {-1e5});
    for (const double duration_s : durations_s)
      out.record_parameters.push_back(
          {linear_parameter(3, 0.1), logarithmic_parameter(duration_s, 0.01, 100)});
    return name(out);
  };
  const double sudden = kSuddenShare * kSeconds;
  EXPECT_EQ(change({sudden * (1 - kNear)}), "stiffness_drop");
  EXPECT_EQ(change({sudden * (1 + kNear)}), "stiffness_drift");
  EXPECT_EQ(change({10, 20}), "stiffness_drift");
  // A record that ends during the change does not show its duration.
  EXPECT_EQ(change({10, 0.05}), "stiffness_drop");
}

TEST(NameOfFit, OtherFormsHaveOneName) {
  struct Named {
    LawForm form;
    std::string_view name;
  };
  const Named all[] = {
      {LawForm::slip_lock, "pinching"},
      {LawForm::slack, "pinching"},
      {LawForm::friction, "coulomb_friction"},
      {LawForm::power_damping, "quadratic_damping"},
      {LawForm::gap_positive, "one_sided_gap"},
      {LawForm::gap_negative, "one_sided_gap"},
      {LawForm::gap_both, "two_sided_gap"},
      {LawForm::mass, "extra_mass"},
      {LawForm::resonator, "tuned_mass_damper"},
      {LawForm::spring, "added_spring"},
      {LawForm::damper, "added_damper"},
      {LawForm::modal_damping, "modal_damping"},
      {LawForm::rocking, "base_rocking"},
      {LawForm::bending, "frame_bending"},
      {LawForm::panels, "floor_flexibility"},
      {LawForm::harmonic, "unmeasured_force"},
      {LawForm::broadband, "unmeasured_force"},
      {LawForm::misaligned, "misalignment"},
      {LawForm::swapped, "swapped"},
      {LawForm::clipped, "clipping"},
  };
  for (const Named& one : all) EXPECT_EQ(name(effect_with(one.form, {1, 1, 1, 1})), one.name);
}

}  // namespace name_of_fit_test
}  // namespace framewatch::estimator
