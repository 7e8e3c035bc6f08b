// SPDX-License-Identifier: MIT
// Component tests simulated here, with separate equations and integration.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/diagnosis_input.h"
#include "estimator/diagnose/verdict/diagnose.h"
#include "estimator/diagnose/verdict/verdict.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::estimator {
namespace component_test {

using Eigen::Index;
using Eigen::MatrixXd;

using Signal = std::function<double(double)>;

/// Returns a sum of tones of unit rms at multiples of step_hz, with random phases.
Signal multisine(double step_hz, double low_hz, double high_hz, std::uint64_t seed) {
  Random random(seed);
  std::vector<std::array<double, 2>> tones;
  for (double hz = std::ceil(low_hz / step_hz) * step_hz; hz < high_hz; hz += step_hz)
    tones.push_back({2 * M_PI * hz, 2 * M_PI * random.uniform()});
  const double size = std::sqrt(2.0 / static_cast<double>(tones.size()));
  return [tones, size](double t) {
    double out = 0;
    for (const auto& [w, phase] : tones) out += size * std::sin(w * t + phase);
    return out;
  };
}

Structure one_frame(double mass_kg) {
  Structure out;
  out.name = "component";
  out.stories = 1;
  out.frames_x = {"f"};
  out.story_height = {1};
  out.node_mass = {mass_kg};
  return out;
}

Diagnosis diagnosis_of(double mass_kg, double stiffness_npm, double rate_hz, bool prescribed,
                       const std::vector<MatrixXd>& records) {
  const Structure structure = one_frame(mass_kg);
  const ParameterTable table(structure);
  Eigen::VectorXd design = Eigen::VectorXd::Zero(table.size());
  design[table.frame_stiffness(1, 0)] = stiffness_npm;
  design = with_proportional_damping(structure, table, design, 0.02);
  ComponentTest component;
  component.force = "u";
  component.displacement = true;
  component.prescribed = prescribed;
  std::vector<RecordSamples> samples;
  for (const MatrixXd& record : records) samples.push_back({rate_hz, record, 0});
  const std::vector<SensorAxis> axes{{"ground", 0, Direction::x, -1}, {"y", 1, Direction::x, 0}};
  const auto input = diagnosis_input(structure, axes, design, component, samples);
  DiagnosisOptions options;
  options.tolerances.mass = 0.1;
  return diagnose(input->plant, input->segments, options);
}

/// The benchmark of Noel and Schoukens, "Hysteretic benchmark with a dynamic nonlinearity", 2016:
/// m y'' + c y' + k y + z = u, z' = alpha y' - beta (gamma |y'| z + delta y' |z|).
struct BoucWenBenchmark {
  static constexpr double kRate_hz = 750;

  struct State {
    double y = 0, v = 0, z = 0;
  };
  static State rates(const State& s, double u) {
    constexpr double kMass = 2, kDamping = 10, kStiffness = 5e4, kAlpha = 5e4, kBeta = 1e3,
                     kGamma = 0.8, kDelta = -1.1;
    return {s.v, (u - kDamping * s.v - kStiffness * s.y - s.z) / kMass,
            kAlpha * s.v - kBeta * (kGamma * std::abs(s.v) * s.z + kDelta * s.v * std::abs(s.z))};
  }
  static State moved(const State& s, const State& r, double h) {
    return {s.y + h * r.y, s.v + h * r.v, s.z + h * r.z};
  }

  /// Returns base at rest, noisy displacement, force. Runge-Kutta with 20 steps per sample; the
  /// first `skipped` samples are not recorded.
  static MatrixXd record(const Signal& force, Index skipped, Index samples) {
    constexpr int kSub = 20;
    constexpr double kNoise_m = 1e-6;
    Random random(7);
    constexpr double h = 1 / (kRate_hz * kSub);
    MatrixXd out = MatrixXd::Zero(samples, 3);
    State s;
    for (Index i = 0; i < skipped + samples; ++i) {
      double t = static_cast<double>(i) / kRate_hz, u = force(t);
      if (i >= skipped) out.row(i - skipped) << 0, s.y + kNoise_m * random.normal(), u;
      for (int j = 0; j < kSub; ++j) {
        const double middle = force(t + h / 2), end = force(t + h);
        const State a = rates(s, u), b = rates(moved(s, a, h / 2), middle),
                    c = rates(moved(s, b, h / 2), middle), d = rates(moved(s, c, h), end);
        s = {s.y + h / 6 * (a.y + 2 * b.y + 2 * c.y + d.y),
             s.v + h / 6 * (a.v + 2 * b.v + 2 * c.v + d.v),
             s.z + h / 6 * (a.z + 2 * b.z + 2 * c.z + d.z)};
        t += h;
        u = end;
      }
    }
    return out;
  }
};

TEST(ComponentTest, NamesTheBoucWenBenchmarkAndSimulatesAnUnseenSweep) {
#ifndef __OPTIMIZE__
  GTEST_SKIP() << "minutes without optimisation";
#endif
  constexpr double kLargestGap = 0.01, kForce_n = 50, kSweepForce_n = 40;
  constexpr double kFrom_hz = 20, kTo_hz = 50, kSeconds = 10;
  const Signal tones = multisine(BoucWenBenchmark::kRate_hz / 1024, 5, 150, 1);
  const MatrixXd train =
      BoucWenBenchmark::record([&](double t) { return kForce_n * tones(t); }, 1024, 4096);
  const auto sweep = [&](double t) {
    return kSweepForce_n *
           std::sin(2 * M_PI * (kFrom_hz * t + (kTo_hz - kFrom_hz) / kSeconds * t * t / 2));
  };
  const MatrixXd unseen =
      BoucWenBenchmark::record(sweep, 0, static_cast<Index>(kSeconds * BoucWenBenchmark::kRate_hz));
  const Diagnosis d = diagnosis_of(2, 1e5, BoucWenBenchmark::kRate_hz, false, {train, unseen});
  ASSERT_EQ(d.effects.size(), 1U);
  EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::bouc_wen);
  EXPECT_LT(d.after[1].overall, kLargestGap);
}

/// A spring that hardens, with damping that grows with the rate.
struct HardeningDamper {
  static constexpr double kRate_hz = 200, kMass_kg = 2, kStiffness_npm = 5e3, kDamping_nspm = 4,
                          kCubic_npm3 = 4e7, kQuadratic_ns2pm2 = 25;

  static double accel(double y, double v, double u) {
    return (u - kDamping_nspm * v - kStiffness_npm * y - kCubic_npm3 * y * y * y -
            kQuadratic_ns2pm2 * v * std::abs(v)) /
           kMass_kg;
  }

  /// Returns base at rest, noisy displacement, force. Stoermer-Verlet with 200 steps per sample.
  static MatrixXd record(double force_n, std::uint64_t seed) {
    constexpr int kSub = 200;
    constexpr Index kSamples = 3000;
    constexpr double kNoise_m = 1e-5, h = 1 / (kRate_hz * kSub);
    const Signal tones = multisine(kRate_hz / kSamples, 1, 12, seed);
    Random random(seed + 100);
    MatrixXd out = MatrixXd::Zero(kSamples, 3);
    double y = 0, v = 0;
    for (Index i = 0; i < kSamples; ++i) {
      const double t = static_cast<double>(i) / kRate_hz, u = force_n * tones(t);
      out.row(i) << 0, y + kNoise_m * random.normal(), u;
      for (int j = 0; j < kSub; ++j) {
        y += h / 2 * v;
        v += h * accel(y, v, force_n * tones(t + (j + 0.5) * h));
        y += h / 2 * v;
      }
    }
    return out;
  }
};

TEST(ComponentTest, NamesAHardeningSpringAndAGrowingDamping) {
#ifndef __OPTIMIZE__
  GTEST_SKIP() << "minutes without optimisation";
#endif
  using Of = HardeningDamper;
  constexpr double kOff = 0.05, kLargestGap = 0.005;
  const Diagnosis d = diagnosis_of(Of::kMass_kg, 1.1 * Of::kStiffness_npm, Of::kRate_hz, false,
                                   {Of::record(5, 1), Of::record(3, 2)});
  ASSERT_EQ(d.effects.size(), 2U);
  EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::cubic_stiffness);
  EXPECT_EQ(d.effects[1].chosen.kind, EffectKind::quadratic_damping);
  // Their forces at the largest motion.
  const ModelEffect &spring = d.model.effects[0], &damper = d.model.effects[1];
  EXPECT_NEAR(spring.parameters[0].plain() / (Of::kCubic_npm3 * std::pow(spring.deformation, 3)), 1,
              kOff);
  EXPECT_NEAR(damper.parameters[0].plain() / (Of::kQuadratic_ns2pm2 * std::pow(damper.rate, 2)), 1,
              kOff);
  EXPECT_LT(d.after[1].overall, kLargestGap);
  EXPECT_EQ(d.verdict, Verdict::explained);
}

/// Returns a record of a spring with a joint that sticks elastically up to `stick` m and then
/// slides.
MatrixXd sliding_record(double stick_m, std::uint64_t seed) {
  constexpr double kRate_hz = 100, kStiffness_npm = 5000, kSlide_n = 400, kNoise_n = 2;
  constexpr int kSub = 50;
  const Signal tones = multisine(1.0 / 60, 0.5, 2.5, seed);
  const double stick_npm = kSlide_n / stick_m;
  Random random(seed + 100);
  MatrixXd out = MatrixXd::Zero(3000, 3);
  double slid = 0;
  for (Index i = 0; i < out.rows(); ++i)
    for (int j = 0; j < kSub; ++j) {
      const double t = (static_cast<double>(i) + static_cast<double>(j) / kSub) / kRate_hz;
      const double d = 0.006 * tones(t);
      slid = std::clamp(slid, d - stick_m, d + stick_m);
      if (j == 0)
        out.row(i) << 0, d + 2e-6 * random.normal(),
            kStiffness_npm * d + stick_npm * (d - slid) + kNoise_n * random.normal();
    }
  return out;
}

TEST(ComponentTest, FindsAnElasticallyStickingJointUnderPrescribedMotion) {
#ifndef __OPTIMIZE__
  GTEST_SKIP() << "minutes without optimisation";
#endif
  constexpr double kStick_m = 0.004, kTolerance = 0.1, kLargestGap = 0.05;
  // The mass of the component does not matter, and is unknown.
  for (const double mass_kg : {0.1, 50.0}) {
    const Diagnosis d = diagnosis_of(mass_kg, 5e4, 100, true,
                                     {sliding_record(kStick_m, 1), sliding_record(kStick_m, 2)});
    ASSERT_EQ(d.effects.size(), 1U) << mass_kg;
    EXPECT_EQ(d.effects[0].chosen.kind, EffectKind::bilinear_hysteresis) << mass_kg;
    EXPECT_NEAR(d.model.effects[0].parameters[1].plain() / kStick_m, 1, kTolerance) << mass_kg;
    EXPECT_LT(d.after[1].overall, kLargestGap) << mass_kg;
  }
}

}  // namespace component_test
}  // namespace framewatch::estimator
