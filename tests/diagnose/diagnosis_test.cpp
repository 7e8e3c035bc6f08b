#include "estimator/diagnose/diagnosis.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/diagnose/free_run.h"
#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/matrices.h"
#include "tests/support/noisy_stretch.h"
#include "tests/support/paper_buildings.h"

namespace framewatch {
namespace {

constexpr double kRate_hz = 50;
constexpr double kNoise_mps2 = 0.01;
constexpr double kSeconds = 24;

/// One story of one bay, small enough for sanitizers: x-parallel frames y1, y2, y-parallel x1, x2.
struct Small {
  Structure structure = one_story();
  ParameterTable table{structure};
  std::vector<SensorAxis> axes;
  Eigen::VectorXd truth, design;

  Small() {
    truth = Eigen::VectorXd::Zero(table.size());
    const double frames[] = {9e6, 6e6, 8e6, 5e6};
    for (int f = 0; f < 4; ++f) truth[table.frame_stiffness(1, f)] = frames[f];
    truth[table.panel_stiffness(1, 0)] = 2e6;
    truth = with_proportional_damping(structure, table, truth, 0.02);
    design = 1.05 * truth;
    for (int f = 0; f < 4; ++f)
      axes.push_back({structure.frame_name(f), 1, structure.direction(f), f});
    axes.push_back({"base-x", 0, Direction::x, -1});
    axes.push_back({"base-y", 0, Direction::y, -1});
  }

  static Structure one_story() {
    Structure s = test::table1();
    s.stories = 1;
    s.story_height.resize(1);
    s.node_mass.resize(static_cast<std::size_t>(s.nodes()));
    return s;
  }

  /// What the axes read with these effects.
  Eigen::MatrixXd record(const std::vector<Effect>& effects, std::uint64_t seed) const {
    ResponseStream stream(structure, table, truth, test::oblique_motion(seed), {kRate_hz}, {}, {},
                          effects);
    Random random(seed + 1000);
    Eigen::MatrixXd out(static_cast<Eigen::Index>(kSeconds * kRate_hz), 6);
    for (Eigen::Index i = 0; i < out.rows(); ++i) {
      const Eigen::VectorXd& exact = stream.next();
      for (Eigen::Index a = 0; a < 6; ++a) out(i, a) = exact[a] + kNoise_mps2 * random.normal();
    }
    return out;
  }

  Diagnosis diagnosis_of(const std::vector<Eigen::MatrixXd>& records) const {
    const auto plant = make_plant(structure, axes, design, kRate_hz);
    const std::vector<double> hz = natural_frequencies_hz(structure, table, design);
    std::vector<Stretch> stretches;
    for (const Eigen::MatrixXd& record : records)
      stretches.push_back(make_stretch(record, kRate_hz, Eigen::VectorXd::Constant(6, kNoise_mps2),
                                       {0.4 * hz.front(), 1.6 * hz.back()}));
    return diagnose(*plant, stretches, {});
  }
};

TEST(Diagnose, NothingHiddenIsAdequate) {
  constexpr double kLow = 0.85, kHigh = 1.15;
  const Small small;
  const Diagnosis d = small.diagnosis_of({small.record({}, 1), small.record({}, 2)});
  EXPECT_EQ(d.verdict, Verdict::adequate);
  EXPECT_TRUE(d.effects.empty());
  EXPECT_GT(d.ratio_before, kLow);
  EXPECT_LT(d.ratio_before, kHigh);
  for (int f = 0; f < 4; ++f)
    EXPECT_NEAR(d.model.theta[f] / small.truth[f], 1, 0.02) << small.table[f].name;
}

TEST(Diagnose, CubicFrameIsPlacedNamedAndSized) {
  constexpr double kTolerance = 0.1;
  const Small small;
  EffectPlace place;
  place.story = 1;
  place.frame = 2;
  Effect cubic = make_effect(EffectKind::cubic_stiffness, place);
  cubic.set("k3_npm3", 8e10);
  const Diagnosis d = small.diagnosis_of({small.record({cubic}, 1), small.record({cubic}, 2)});
  EXPECT_EQ(d.verdict, Verdict::explained);
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::cubic_stiffness);
  EXPECT_EQ(d.effects[0].chosen.place, place);
  EXPECT_LT(d.effects[0].after, d.effects[0].before);
  const ModelEffect& e = d.model.effects[0];
  EXPECT_NEAR(e.knobs[0].plain() / std::pow(e.deformation, 3) / 8e10, 1, kTolerance);
}

TEST(Diagnose, GainOfOneChannelIsNotPhysics) {
  const Small small;
  std::vector<Eigen::MatrixXd> records{small.record({}, 1), small.record({}, 2)};
  for (Eigen::MatrixXd& record : records) record.col(1) *= 1.08;
  const Diagnosis d = small.diagnosis_of(records);
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::gain_error);
  EXPECT_EQ(d.effects[0].chosen.place.channel, 1);
  EXPECT_NEAR(d.model.gain[1], 0.08, 0.01);
}

TEST(Diagnose, RecordsOfDifferentBuildingsAreSaidToBe) {
  const Small small;
  Small other;
  for (int f = 0; f < 4; ++f)
    other.truth[other.table.frame_stiffness(1, f)] *= f % 2 == 0 ? 1.4 : 0.75;
  const Diagnosis d = small.diagnosis_of({small.record({}, 1), other.record({}, 2)});
  EXPECT_EQ(d.verdict, Verdict::unexplained);
  EXPECT_TRUE(d.effects.empty());
  EXPECT_NE(d.reason.find("different buildings"), std::string::npos) << d.reason;
}

TEST(Diagnose, ARecordWithoutCommonTimeIsNotNamedAsPhysics) {
  constexpr int kLate = 40;  // 0.8 s
  const Small small;
  std::vector<Eigen::MatrixXd> records{small.record({}, 1), small.record({}, 2)};
  // One recorder has two of the floor's channels, another the rest.
  const Eigen::Index rows = records[1].rows();
  for (Eigen::MatrixXd& record : records) {
    const Eigen::MatrixXd late = record.block(0, 0, rows - kLate, 2);
    record.block(kLate, 0, rows - kLate, 2) = late;
  }
  const Diagnosis d = small.diagnosis_of(records);
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

TEST(LawMotion, LawsOppose) {
  for (const LawForm form : {LawForm::friction, LawForm::power_damping}) {
    LawMotion motion({form, {5.0, 2.0}, 1, 1});
    EXPECT_GT(motion.force(0, 1, 0), 0);
    EXPECT_LT(motion.force(0, -1, 0), 0);
  }
}

TEST(Stretch, QuietNoiseIsFoundBesideStrongMotion) {
  constexpr double kTolerance = 0.12;
  Random random(7);
  Eigen::VectorXd a(12000);
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    const double t = static_cast<double>(i) / 200;
    a[i] = 0.01 * random.normal() + (t > 10 ? 3 * std::sin(8 * t) : 0);
  }
  EXPECT_NEAR(std::sqrt(quiet_noise_variance(a, 200)) / 0.01, 1, kTolerance);
}

TEST(Stretch, BandGoesToTimeAndBack) {
  Random random(3);
  Eigen::MatrixXd a(1001, 1);
  for (Eigen::Index i = 0; i < a.rows(); ++i) a(i, 0) = random.normal();
  const Stretch s = make_stretch(a, kRate_hz, Eigen::VectorXd::Constant(1, 1.0), {1, 10});
  const Eigen::VectorXcd bins = s.spectrum.row(0).transpose();
  EXPECT_LT((band_of(signal_of(bins, s, 4), s, 4) - bins).norm(), 1e-9 * bins.norm());
}

}  // namespace
}  // namespace framewatch
