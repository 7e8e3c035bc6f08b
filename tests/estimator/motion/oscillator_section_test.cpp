// SPDX-License-Identifier: MIT
#include "estimator/motion/derivative_triple.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "estimator/motion/drift_controlled_integrator.h"

namespace framewatch::estimator {
namespace oscillator_section_test {

constexpr double kRate = 100, kCorner = 0.5, kDamping = 0.35;
constexpr double kIntegratorError = 0.012;  // from ten times the corner on
constexpr double kBalance = 2e-4;  // residual of the equation of motion over its largest term

/// Returns the response of the recursion times the numerator, which the derivative triple holds.
std::complex<double> response(const OscillatorSection& section, double hz, double rate_hz) {
  const std::complex<double> z = std::polar(1.0, -2 * M_PI * hz / rate_hz);
  return section.gain * (1.0 + z) * (1.0 + z) / 4.0 / (1.0 + section.a1 * z + section.a2 * z * z);
}

struct Section {
  OscillatorSection of;
  double last = 0, before = 0;
  double push(double x) {
    const double s = of.gain * x - of.a1 * last - of.a2 * before;
    before = last;
    return last = s;
  }
};

TEST(OscillatorSection, IntegratesTwiceAboveItsCorner) {
  constexpr double kFineRate = 1000;  // where the error of the bilinear transform is negligible
  const OscillatorSection section(kCorner, 1e-3, kFineRate);
  const double w = 2 * M_PI * kCorner;
  for (const double hz : {10 * kCorner, 20 * kCorner}) {
    const std::complex<double> s(0, 2 * M_PI * hz);
    const std::complex<double> twice = w * w / (s * s);
    EXPECT_LT(std::abs(response(section, hz, kFineRate) / twice - 1.0), kIntegratorError) << hz;
  }
}

TEST(OscillatorSection, DoesNotAccumulateBelowItsCorner) {
  const OscillatorSection section(kCorner, kDamping, kRate);
  EXPECT_NEAR(std::abs(response(section, 0, kRate)), 1, 1e-12);
  EXPECT_NEAR(std::abs(response(section, kCorner, kRate)), 1 / (2 * kDamping), 1e-6);
  Section still{section};
  double after = 0;
  for (int i = 0; i < 6000; ++i) after = still.push(i < 3000 ? 1 : 0);
  EXPECT_LT(std::abs(after), 1e-12) << "a bias that has gone is forgotten";
}

/// A freely swinging oscillator with a biased accelerometer: m a + c v + k d = 0 holds between the
/// three outputs, with the corner below, at and above the motion.
TEST(OscillatorSection, KeepsTheEquationOfMotionWhateverTheCorner) {
  const double w = 2 * M_PI * 2, h = 0.005, bias = 3;
  const std::complex<double> pole(-h * w, w * std::sqrt(1 - h * h));
  for (const double corner : {0.3, 2.0, 6.0}) {
    DriftControlledIntegrator integrator({matched_triple(kRate)}, HighPass(0.3, kRate));
    std::array<Section, 3> sections{{{OscillatorSection(corner, kDamping, kRate)},
                                     {OscillatorSection(corner, kDamping, kRate)},
                                     {OscillatorSection(corner, kDamping, kRate)}}};
    double residual = 0, largest = 0;
    for (int i = 0; i < 3000; ++i) {
      const std::complex<double> y = std::exp(pole * (i / kRate));
      integrator.push({(pole * pole * y).real() + bias});
      const double d = sections[0].push(integrator.value(0));
      const double v = sections[1].push(integrator.first(0));
      const double a = sections[2].push(integrator.second(0));
      if (i < 2500) continue;  // the start is forgotten by then
      residual = std::max(residual, std::abs(a + 2 * h * w * v + w * w * d));
      largest = std::max(largest, std::abs(a));
    }
    EXPECT_GT(largest, 0);
    EXPECT_LT(residual, kBalance * largest) << corner;
  }
}

}  // namespace oscillator_section_test
}  // namespace framewatch::estimator
