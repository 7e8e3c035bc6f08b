// SPDX-License-Identifier: MIT
#include "estimator/diagnose/verdict/diagnose.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/diagnose/law/law_parameter.h"
#include "estimator/diagnose/model/free_run.h"
#include "estimator/simulate/random.h"
#include "tests/estimator/diagnose/small_building.h"

namespace framewatch::estimator {
namespace diagnosis_test {

using test::Small;

Diagnosis diagnosis_of(const Small& small, const std::vector<Eigen::MatrixXd>& records) {
  const Plant plant = small.plant();
  return diagnose(plant, small.segments(records), {});
}

TEST(Diagnose, FindsTheModelAdequateIfNothingIsHidden) {
  constexpr double kLow = 0.85, kHigh = 1.15;
  const Small small;
  const Diagnosis d = diagnosis_of(small, {small.record({}, 1), small.record({}, 2)});
  EXPECT_EQ(d.verdict, Verdict::adequate);
  EXPECT_TRUE(d.effects.empty());
  EXPECT_GT(d.ratio_before, kLow);
  EXPECT_LT(d.ratio_before, kHigh);
  for (int f = 0; f < 4; ++f)
    EXPECT_NEAR(d.model.theta[f] / small.truth[f], 1, 0.02) << small.table[f].name;
}

TEST(Diagnose, FindsPlaceNameAndSizeOfACubicFrame) {
  constexpr double kTolerance = 0.1;
  const Small small;
  EffectPlace place;
  place.story = 1;
  place.frame = 2;
  Effect cubic = make_effect(EffectKind::cubic_stiffness, place);
  cubic.set("k3_npm3", 8e10);
  const Diagnosis d = diagnosis_of(small, {small.record({cubic}, 1), small.record({cubic}, 2)});
  EXPECT_EQ(d.verdict, Verdict::explained);
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::cubic_stiffness);
  EXPECT_EQ(d.effects[0].chosen.place, place);
  EXPECT_LT(d.effects[0].after, d.effects[0].before);
  const ModelEffect& e = d.model.effects.back();
  EXPECT_NEAR(e.parameters[0].plain() / std::pow(e.deformation, 3) / 8e10, 1, kTolerance);
}

TEST(Diagnose, AttributesAGainErrorToTheChannel) {
  const Small small;
  std::vector<Eigen::MatrixXd> records{small.record({}, 1), small.record({}, 2)};
  for (Eigen::MatrixXd& record : records) record.col(1) *= 1.08;
  const Diagnosis d = diagnosis_of(small, records);
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::gain_error);
  EXPECT_EQ(d.effects[0].chosen.place.channel, 1);
  EXPECT_NEAR(d.model.gain[1], 0.08, 0.01);
}

TEST(Diagnose, TimesADropFromAllRecords) {
  const Small small;
  EffectPlace place;
  place.story = 1;
  place.frame = 3;
  Effect drop = make_effect(EffectKind::stiffness_drop, place);
  const double change = -0.03 * small.truth[small.table.frame_stiffness(1, 3)];
  drop.set("dk_npm", change);
  drop.set("at_s", 14);
  Effect long_ago = drop;
  long_ago.set("at_s", 0);
  const Diagnosis d = diagnosis_of(small, {small.record({drop}, 1), small.record({long_ago}, 2)});
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::stiffness_drop);
  EXPECT_EQ(d.effects[0].chosen.place, place);
  EXPECT_NEAR(d.model.effects.back().parameters[0].plain() / change, 1, 0.1);
  EXPECT_NEAR(d.model.effects.back().record_parameters[0][0].plain(), 14, 0.5);
}

TEST(Diagnose, FindsTheOnsetOfAHarmonicForce) {
  constexpr double kFrom_s = 6.3, kForce_n = 2000, kNear_s = 0.2;
  const Small small;
  EffectPlace place;
  place.kind = PlaceKind::node;
  place.story = 1;
  place.frame = 1;
  Effect force = make_effect(EffectKind::unmeasured_force, place);
  force.set("amplitude_n", kForce_n);
  force.set("frequency_hz", 3.3);
  force.set("rms_n", 0);
  Effect late = force;
  late.set("from_s", kFrom_s);
  const Diagnosis d = diagnosis_of(small, {small.record({force}, 1), small.record({late}, 2)});
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::unmeasured_force);
  const ModelEffect& e = d.model.effects.back();
  EXPECT_LT(e.onset_s[0], kNear_s);
  EXPECT_NEAR(e.onset_s[1], kFrom_s, kNear_s);
  for (const std::vector<LawParameter>& waves : e.record_parameters)
    EXPECT_NEAR(std::hypot(waves[0].plain(), waves[1].plain()) / kForce_n, 1, 0.02);
}

TEST(Diagnose, ReportsRecordsOfDifferentBuildings) {
  const Small small;
  Small other;
  for (int f = 0; f < 4; ++f)
    other.truth[other.table.frame_stiffness(1, f)] *= f % 2 == 0 ? 1.4 : 0.75;
  const Diagnosis d = diagnosis_of(small, {small.record({}, 1), other.record({}, 2)});
  EXPECT_EQ(d.verdict, Verdict::unexplained);
  EXPECT_TRUE(d.effects.empty());
  EXPECT_NE(d.reason.find("different buildings"), std::string::npos) << d.reason;
}

TEST(Diagnose, NamesNoPhysicalEffectForARecordWithoutCommonTime) {
  constexpr int kLate = 40;  // 0.8 s
  const Small small;
  std::vector<Eigen::MatrixXd> records{small.record({}, 1), small.record({}, 2)};
  // One recorder has two of the floor's channels, another has the rest.
  const Eigen::Index rows = records[1].rows();
  for (Eigen::MatrixXd& record : records) {
    const Eigen::MatrixXd late = record.block(0, 0, rows - kLate, 2);
    record.block(kLate, 0, rows - kLate, 2) = late;
  }
  const Diagnosis d = diagnosis_of(small, records);
  for (const FoundEffect& f : d.effects) EXPECT_EQ(f.chosen.kind, EffectKind::time_shift);
  if (d.effects.size() < 2) {
    EXPECT_NE(d.verdict, Verdict::explained);
    EXPECT_NE(d.verdict, Verdict::adequate);
  }
}

TEST(LawMotion, HysteresisClosesItsLoopAtTheYieldForce) {
  LawValues values{LawForm::hysteresis, {1000, 0.01, 40, 0.5}, 1, 1};
  LawMotion motion(values);
  for (int i = 0; i <= 300; ++i) motion.accept(1e-4 * i, 1, 0);
  EXPECT_NEAR(motion.force(0.0301, 1, 0), 10.0, 1e-9);
  EXPECT_NEAR(motion.force(0.02, -1, 0), 0.0, 0.01);
}

TEST(LawMotion, HysteresisSlidesFarInOneStep) {
  constexpr double kYields_m = 1e-6, kFar_m = 5e-4;
  for (const double n : {1.0, 2.0, 7.5}) {
    LawMotion motion({LawForm::hysteresis, {1e6, kYields_m, n, 0.5}, 1, 1});
    EXPECT_NEAR(motion.force(kFar_m, 1, 0), 1.0, 1e-9) << n;
    motion.accept(kFar_m, 1, 0);
    double before = 1;
    for (double back = 0.1 * kYields_m; back < kFar_m; back *= 1.5) {
      const double force = motion.force(kFar_m - back, -1, 0);
      EXPECT_LE(force, before) << n << " " << back;
      before = force;
    }
    EXPECT_NEAR(before, -1.0, 1e-9) << n;
  }
}

TEST(LawMotion, LawsOppose) {
  for (const LawForm form : {LawForm::friction, LawForm::power_damping}) {
    LawMotion motion({form, {5.0, 2.0}, 1, 1});
    EXPECT_GT(motion.force(0, 1, 0), 0);
    EXPECT_LT(motion.force(0, -1, 0), 0);
  }
}

TEST(RecordSegment, FindsQuietNoiseBesideStrongMotion) {
  constexpr double kTolerance = 0.12;
  Random random(7);
  Eigen::VectorXd a(12000);
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double t = static_cast<double>(i) / 200;
    a[i] = 0.01 * random.normal() + (t > 10 ? 3 * std::sin(8 * t) : 0);
  }
  EXPECT_NEAR(std::sqrt(quiet_noise_variance(a, 200)) / 0.01, 1, kTolerance);
}

TEST(RecordSegment, TransformsABandToTimeAndBack) {
  Random random(3);
  Eigen::MatrixXd a(1001, 1);
  for (Eigen::Index i = 0; i < a.rows(); ++i) a(i, 0) = random.normal();
  const RecordSegment s =
      make_segment(a, test::kRate_hz, Eigen::VectorXd::Constant(1, 1.0), {1, 10});
  const Eigen::VectorXcd bins = s.spectrum.row(0).transpose();
  EXPECT_LT((band_of(signal_of(bins, s, 4), s, 4) - bins).norm(), 1e-9 * bins.norm());
}

}  // namespace diagnosis_test
}  // namespace framewatch::estimator
