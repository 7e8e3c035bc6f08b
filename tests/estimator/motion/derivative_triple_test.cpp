// SPDX-License-Identifier: MIT
#include "estimator/motion/derivative_triple.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include <gtest/gtest.h>

namespace framewatch::estimator {
namespace derivative_triple_test {

using Complex = std::complex<double>;

/// The limit that the header states: relative error up to a fifth of the rate.
constexpr double kBandLimit = 1e-4;

/// Returns the frequency response of taps (newest first) without the delay of `delay` samples.
Complex response(const std::vector<double>& taps, double w, double delay) {
  Complex sum = 0;
  for (std::size_t k = 0; k < taps.size(); ++k)
    sum += taps[k] * std::polar(1.0, -w * (static_cast<double>(k) - delay));
  return sum;
}

/// Returns the largest relative error of p' and p'' against p, from 0.05 Hz to highest_hz.
double worst_error(const DerivativeTriple& t, double rate_hz, double highest_hz) {
  double worst = 0;
  for (double hz = 0.05; hz <= highest_hz; hz += 0.05) {
    const double w = 2 * M_PI * hz / rate_hz;
    const Complex s(0, 2 * M_PI * hz);
    const Complex p = response(t.value, w, t.delay);
    worst = std::max(worst, std::abs(response(t.first, w, t.delay) / (s * p) - 1.0));
    worst = std::max(worst, std::abs(response(t.second, w, t.delay) / (s * s * p) - 1.0));
  }
  return worst;
}

TEST(DerivativeTriple, IsExactEnoughUpToAFifthOfTheRate) {
  for (const double rate_hz : {100.0, 120.0, 200.0, 1000.0})
    EXPECT_LT(worst_error(matched_triple(rate_hz), rate_hz, rate_hz / 5), kBandLimit) << rate_hz;
}

TEST(DerivativeTriple, IsFarBetterWhereBuildingsMove) {
  EXPECT_LT(worst_error(matched_triple(100), 100, 10), 2e-5);
}

TEST(DerivativeTriple, ValueIsTheNumeratorOfTheBilinearLowPass) {
  for (const DerivativeTriple& t : {matched_triple(100), trapezoid_triple(100)}) {
    for (const double w : {0.01, 0.3, 1.2}) {
      const double expected = std::pow(std::cos(w / 2), 2);
      EXPECT_NEAR(std::abs(response(t.value, w, t.delay) - expected), 0, 1e-14);
    }
  }
}

TEST(DerivativeTriple, SpanAndDelayAreCommonToAllThree) {
  for (const DerivativeTriple& t : {matched_triple(100), trapezoid_triple(100)}) {
    EXPECT_EQ(t.first.size(), t.value.size());
    EXPECT_EQ(t.second.size(), t.value.size());
    EXPECT_EQ(t.delay, (t.length() - 1) / 2.0);
  }
}

TEST(DerivativeTriple, ConstantsAndRampsAreExact) {
  const double rate = 100;
  const DerivativeTriple t = matched_triple(rate);
  double c1 = 0, c2 = 0, ramp0 = 0, ramp1 = 0, ramp2 = 0;
  for (std::size_t k = 0; k < t.value.size(); ++k) {
    const double x = (t.delay - static_cast<double>(k)) / rate;  // time about the center
    c1 += t.first[k];
    c2 += t.second[k];
    ramp0 += t.value[k] * x;
    ramp1 += t.first[k] * x;
    ramp2 += t.second[k] * x;
  }
  EXPECT_NEAR(c1, 0, 1e-12 * rate);
  EXPECT_NEAR(c2, 0, 1e-12 * rate * rate);
  EXPECT_NEAR(ramp0, 0, 1e-14);
  EXPECT_NEAR(ramp1, 1, 1e-12);
  EXPECT_NEAR(ramp2, 0, 1e-12 * rate);
}

TEST(DerivativeTriple, AdvanceShiftsByAFractionOfASample) {
  const double rate = 100;
  for (const double advance : {-0.5, -0.2, 0.5}) {
    const DerivativeTriple t = matched_triple(rate, advance), plain = matched_triple(rate);
    ASSERT_EQ(t.delay, plain.delay);
    for (double hz = 0.1; hz <= 10; hz += 0.1) {
      const double w = 2 * M_PI * hz / rate;
      const Complex shift = std::polar(1.0, w * advance);
      for (const auto taps :
           {&DerivativeTriple::value, &DerivativeTriple::first, &DerivativeTriple::second}) {
        const Complex wanted = shift * response(plain.*taps, w, plain.delay);
        EXPECT_LT(std::abs(response(t.*taps, w, t.delay) / wanted - 1.0), 1e-3) << hz;
      }
    }
  }
}

/// Returns the taps applied to x at i.
double applied(const std::vector<double>& taps, const std::vector<double>& x, std::size_t i) {
  double sum = 0;
  for (std::size_t k = 0; k < taps.size(); ++k) sum += taps[k] * x[i - k];
  return sum;
}

TEST(DerivativeTriple, TrapezoidIsTwoTrapezoidalIntegrations) {
  const double rate = 50, h = 1 / rate;
  const DerivativeTriple t = trapezoid_triple(rate);
  std::vector<double> x;
  for (int i = 0; i < 60; ++i) x.push_back(std::sin(0.7 * i * i));
  double p0 = applied(t.value, x, 2), p1 = applied(t.first, x, 2);
  for (std::size_t i = 3; i < x.size(); ++i) {
    const double q = applied(t.second, x, i), q_before = applied(t.second, x, i - 1);
    const double p1_before = p1;
    p1 += h / 2 * (q + q_before);
    p0 += h / 2 * (p1 + p1_before);
    EXPECT_NEAR(applied(t.first, x, i), p1, 1e-9);
    EXPECT_NEAR(applied(t.value, x, i), p0, 1e-10);
  }
}

}  // namespace derivative_triple_test
}  // namespace framewatch::estimator
