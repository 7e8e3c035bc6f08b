// SPDX-License-Identifier: MIT
#include "estimator/diagnose/spectra/fourier.h"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace fourier_test {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double kRounding = 1e-10;
constexpr Index kSizes[] = {2, 3, 5, 30, 45, 64, 225};
constexpr Index kLargestSize = 3000;

VectorXd noise(Index size, std::uint64_t seed) {
  Random random(seed);
  VectorXd out(size);
  for (double& x : out) x = random.normal();
  return out;
}

/// Computes the transform by its definition, term by term.
VectorXcd slow_transform(const VectorXd& signal) {
  VectorXcd out = VectorXcd::Zero(signal.size() / 2 + 1);
  for (Index k = 0; k < out.size(); ++k)
    for (Index i = 0; i < signal.size(); ++i)
      out[k] += signal[i] * std::polar(1.0, -2 * M_PI * static_cast<double>(k * i) /
                                                static_cast<double>(signal.size()));
  return out;
}

bool only_small_factors(Index number) {
  for (const Index factor : {2, 3, 5})
    while (number % factor == 0) number /= factor;
  return number == 1;
}

TEST(Fourier, ForwardIsTheSumOfSamples) {
  for (const Index size : kSizes) {
    const VectorXd signal = noise(size, 1);
    const VectorXcd half = forward_fourier(signal);
    ASSERT_EQ(half.size(), size / 2 + 1);
    EXPECT_LT((half - slow_transform(signal)).norm(), kRounding * static_cast<double>(size));
  }
}

TEST(Fourier, TransformsKnownSignals) {
  constexpr Index kSize = 60, kBin = 7, kAt = 11;
  constexpr double kAmplitude = 3, kPhase = 0.4;
  VectorXd wave(kSize), constant = VectorXd::Constant(kSize, kAmplitude), alternating(kSize);
  for (Index i = 0; i < kSize; ++i) {
    wave[i] = kAmplitude * std::cos(2 * M_PI * static_cast<double>(kBin * i) / kSize + kPhase);
    alternating[i] = i % 2 == 0 ? kAmplitude : -kAmplitude;
  }
  const auto only = [&](const VectorXd& signal, Index bin, Complex value) {
    VectorXcd expected = VectorXcd::Zero(kSize / 2 + 1);
    expected[bin] = value;
    EXPECT_LT((forward_fourier(signal) - expected).norm(), kRounding) << "bin " << bin;
  };
  only(wave, kBin, std::polar(kAmplitude * kSize / 2, kPhase));
  only(constant, 0, kAmplitude * kSize);
  only(alternating, kSize / 2, kAmplitude * kSize);
  const VectorXcd impulse = forward_fourier(VectorXd::Unit(kSize, kAt));
  for (Index k = 0; k < impulse.size(); ++k)
    EXPECT_LT(
        std::abs(impulse[k] - std::polar(1.0, -2 * M_PI * static_cast<double>(k * kAt) / kSize)),
        kRounding);
}

TEST(Fourier, PowerIsThatOfTheSignal) {
  for (const Index size : kSizes) {
    const VectorXd signal = noise(size, 2);
    const VectorXcd half = forward_fourier(signal);
    double power = 2 * half.squaredNorm() - std::norm(half[0]);
    if (size % 2 == 0) power -= std::norm(half[half.size() - 1]);
    EXPECT_NEAR(power / static_cast<double>(size), signal.squaredNorm(),
                kRounding * static_cast<double>(size))
        << size;
  }
}

TEST(Fourier, InverseUndoesForward) {
  for (const Index size : kSizes) {
    const VectorXd signal = noise(size, 3);
    EXPECT_LT((inverse_fourier(forward_fourier(signal), size) - signal).norm(), kRounding) << size;
  }
}

TEST(Fourier, MissingBinsAreZeroAndSurplusBinsAreIgnored) {
  constexpr Index kSize = 48, kGiven = 5;
  const VectorXd signal = noise(kSize, 4);
  VectorXcd half = forward_fourier(signal);
  VectorXcd longer = VectorXcd::Constant(half.size() + 3, 17);
  longer.head(half.size()) = half;
  EXPECT_LT((inverse_fourier(longer, kSize) - signal).norm(), kRounding);
  const VectorXd low = inverse_fourier(half.head(kGiven), kSize);
  half.tail(half.size() - kGiven).setZero();
  EXPECT_LT((forward_fourier(low) - half).norm(), kRounding * kSize);
}

TEST(Fourier, SmoothSizeIsTheLargestBelow) {
  EXPECT_EQ(smooth_size(0), 0);
  Index largest = 1;
  for (Index size = 1; size <= kLargestSize; ++size) {
    if (only_small_factors(size)) largest = size;
    ASSERT_EQ(smooth_size(size), largest) << size;
  }
}

constexpr double kRate_hz = 50;
constexpr Index kSamples = 3000, kLate = 40;
constexpr Band kBand{0.2, 2};
constexpr double kAlike = 0.9;

/// Random motion, and the same motion `kLate` samples later with noise and another amplitude.
struct Readings {
  VectorXd first{kSamples}, second{kSamples};

  explicit Readings(double factor) {
    Random random(3);
    VectorXd motion(kSamples + kLate);
    for (double& x : motion) x = random.normal();
    first = motion.tail(kSamples);
    second = factor * motion.head(kSamples);
    for (double& x : second) x += 0.1 * random.normal();
  }
};

TEST(Delay, IsFoundForMotionOfAnySizeAndSign) {
  for (const double factor : {1.5, -0.7}) {
    const Readings r(factor);
    const Delay late = delay_between(r.first, r.second, kRate_hz, kBand);
    EXPECT_DOUBLE_EQ(late.seconds, kLate / kRate_hz);
    EXPECT_GT(late.likeness, kAlike);
    EXPECT_LE(late.likeness, 1);
    EXPECT_LT(late.undelayed, 0.5);
    EXPECT_DOUBLE_EQ(delay_between(r.second, r.first, kRate_hz, kBand).seconds, -late.seconds);
  }
}

TEST(Delay, IsNotFoundForUnlikeReadings) {
  Random random(4);
  VectorXd first(kSamples), second(kSamples);
  for (Index i = 0; i < kSamples; ++i) {
    first[i] = random.normal();
    second[i] = random.normal();
  }
  EXPECT_LT(delay_between(first, second, kRate_hz, kBand).likeness, 0.6);
}

TEST(Delay, NeedsFrequenciesInTheBandAndMotion) {
  const Readings r(1);
  EXPECT_EQ(delay_between(r.first, r.second, kRate_hz, {0.2, 0.25}).likeness, 0);
  EXPECT_EQ(delay_between(r.first, VectorXd::Zero(kSamples), kRate_hz, kBand).likeness, 0);
  EXPECT_EQ(delay_between(r.first, VectorXd(), kRate_hz, kBand).likeness, 0);
}

}  // namespace fourier_test

}  // namespace framewatch::estimator
