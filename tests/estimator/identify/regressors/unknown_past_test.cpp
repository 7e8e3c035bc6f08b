// SPDX-License-Identifier: MIT
// Compares rows of a filter that starts in full motion with rows of one that has always run.
#include "estimator/identify/regressors/unknown_past.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/identify/regressors/floor_rows.h"
#include "estimator/motion/derivative_triple.h"
#include "estimator/motion/drift_controlled_integrator.h"
#include "estimator/state/archive.h"

namespace framewatch::estimator {
namespace unknown_past_test {

constexpr double kRate_hz = 100, kHighPass_hz = 0.3, kDamping = 0.35;
constexpr int kStride = 4, kSignals = 3, kStart = 1000, kRows = 1500;
constexpr int kShapes = 4;
constexpr double kRounding = 1e-9;  // share of the rows' energy
constexpr double kLeft = 1e-5;      // share of the rows' energy: shapes end at a thousandth

PolePair high_pass_poles() {
  const HighPass h(kHighPass_hz, kRate_hz);
  return {h.a1, h.a2};
}

PolePair section_poles(double hz) {
  const OscillatorSection s(hz, kDamping, kRate_hz);
  return {s.a1, s.a2};
}

/// Applies high-pass and oscillator section to one signal from instant `start` on.
std::vector<double> filtered(const std::vector<double>& x, int start, double hz) {
  const HighPass h(kHighPass_hz, kRate_hz);
  const OscillatorSection o(hz, kDamping, kRate_hz);
  std::vector<double> out(x.size(), 0.0);
  double x1 = x[static_cast<std::size_t>(start)], x2 = x1, y1 = 0, y2 = 0, s1 = 0, s2 = 0;
  for (std::size_t t = static_cast<std::size_t>(start); t < x.size(); ++t) {
    const double y = h.gain * (x[t] - 2 * x1 + x2) - h.a1 * y1 - h.a2 * y2;
    const double s = o.gain * y - o.a1 * s1 - o.a2 * s2;
    x2 = x1, x1 = x[t], y2 = y1, y1 = y, s2 = s1, s1 = s;
    out[t] = s;
  }
  return out;
}

/// Motion of several signals without a start, up to kRows instants after kStart.
std::vector<std::vector<double>> motion() {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<std::vector<double>> out(kSignals);
  for (auto& signal : out) {
    double smooth = 0, drift = 0;
    for (int t = 0; t < kStart + kRows; ++t) {
      smooth += 0.2 * (normal(random) - smooth);
      drift += 0.01 * normal(random);
      signal.push_back(smooth + drift);
    }
  }
  return out;
}

/// Returns rows [signals..., 0] from instant kStart on, of filters that began at `start`.
std::vector<double> rows(int start, double hz) {
  std::vector<double> out(static_cast<std::size_t>(kRows * kStride), 0.0);
  const auto signals = motion();
  for (std::size_t i = 0; i < kSignals; ++i) {
    const std::vector<double> y = filtered(signals[i], start, hz);
    for (std::size_t t = 0; t < kRows; ++t) out[t * kStride + i] = y[t + kStart];
  }
  return out;
}

double energy(const std::vector<double>& rows, int from, int to) {
  double sum = 0;
  for (int t = from; t < to; ++t)
    for (std::size_t k = 0; k < kStride; ++k)
      sum += std::pow(rows[static_cast<std::size_t>(t * kStride) + k], 2);
  return sum;
}

UnknownPast past_of(double hz) {
  UnknownPast past(kStride, 1, kShapes);
  past.begin(1);
  past.add(0, high_pass_poles());
  past.add(0, section_poles(hz));
  return past;
}

std::vector<double> removed(UnknownPast past, std::vector<double> rows, int* uncounted = nullptr) {
  int without = 0;
  for (std::size_t t = 0; t < kRows; ++t)
    if (!past.remove(&rows[t * kStride])) ++without;
  if (uncounted != nullptr) *uncounted = without;
  return rows;
}

/// A filter that starts in motion and one that has always run give the same recursive residuals:
/// nothing of the past remains.
TEST(UnknownPast, RemovesThePast) {
  for (const double hz : {0.31, 1.0, 4.0, 15.0}) {
    const std::vector<double> always = removed(past_of(hz), rows(0, hz));
    const std::vector<double> started = removed(past_of(hz), rows(kStart, hz));
    double difference = 0;
    for (std::size_t i = 0; i < always.size(); ++i)
      difference += std::pow(always[i] - started[i], 2);
    EXPECT_LT(difference, kLeft * energy(always, 0, kRows)) << hz;
    // Without removal the difference is as large as the motion.
    const std::vector<double> a = rows(0, hz), b = rows(kStart, hz);
    double raw = 0;
    for (std::size_t i = 0; i < a.size(); ++i) raw += std::pow(a[i] - b[i], 2);
    EXPECT_GT(raw, 1e-4 * energy(a, 0, kRows)) << hz;
  }
}

/// The sum of h h^T of the residuals equals the sum with the shapes projected out of all rows.
TEST(UnknownPast, SumsEqualThoseOfAProjection) {
  constexpr int kSome = 200;
  const double hz = 2;
  const std::vector<double> all = rows(kStart, hz);
  std::vector<std::vector<double>> shapes;  // orthonormal, by Gram and Schmidt, twice
  for (const PolePair& poles : {high_pass_poles(), section_poles(hz)}) {
    for (const double now : {1.0, 0.0}) {
      std::vector<double> shape;
      double s1 = now, s2 = 1 - now;
      for (int t = 0; t < kSome; ++t) {
        const double s = -poles.a1 * s1 - poles.a2 * s2;
        s2 = s1, s1 = s;
        shape.push_back(s);
      }
      for (int again = 0; again < 2; ++again)
        for (const auto& before : shapes) {
          double dot = 0;
          for (std::size_t t = 0; t < kSome; ++t) dot += before[t] * shape[t];
          for (std::size_t t = 0; t < kSome; ++t) shape[t] -= dot * before[t];
        }
      double square = 0;
      for (const double s : shape) square += s * s;
      for (double& s : shape) s /= std::sqrt(square);
      shapes.push_back(shape);
    }
  }
  const std::vector<double> left = removed(past_of(hz), all);
  for (std::size_t i = 0; i < kSignals; ++i)
    for (std::size_t k = i; k < kSignals; ++k) {
      double projected = 0, sum = 0, whole = 0;
      for (std::size_t t = 0; t < kSome; ++t) {
        projected += all[t * kStride + i] * all[t * kStride + k];
        sum += left[t * kStride + i] * left[t * kStride + k];
        whole += all[t * kStride + i] * all[t * kStride + i];
      }
      for (const auto& shape : shapes) {
        double a = 0, b = 0;
        for (std::size_t t = 0; t < kSome; ++t) {
          a += shape[t] * all[t * kStride + i];
          b += shape[t] * all[t * kStride + k];
        }
        projected -= a * b;
      }
      EXPECT_NEAR(sum, projected, kRounding * whole) << i << " " << k;
    }
}

/// Each shape costs one row. After all have decayed, rows pass unchanged.
TEST(UnknownPast, CostsOneRowPerShapeUntilTheyDecay) {
  const double hz = 2;
  int uncounted = 0;
  const std::vector<double> all = rows(kStart, hz);
  const std::vector<double> left = removed(past_of(hz), all, &uncounted);
  EXPECT_EQ(uncounted, kShapes);
  EXPECT_LT(energy(left, 0, kShapes), kRounding * energy(all, 0, kRows));
  for (std::size_t i = (kRows - 100) * kStride; i < all.size(); ++i) EXPECT_EQ(left[i], all[i]);
}

TEST(UnknownPast, WithoutEquationsNothingIsRemoved) {
  UnknownPast past(kStride, 1, kShapes);
  std::vector<double> row{1, 2, 3, 0};
  EXPECT_TRUE(past.remove(row.data()));
  EXPECT_EQ(row, (std::vector<double>{1, 2, 3, 0}));
}

/// Two equal pairs of poles act as one pair: nothing becomes infinite.
TEST(UnknownPast, AcceptsEqualPoles) {
  UnknownPast past(kStride, 1, 2 * kShapes);
  past.begin(1);
  for (int i = 0; i < 2; ++i) past.add(0, section_poles(2));
  const std::vector<double> left = removed(past, rows(kStart, 2));
  for (const double x : left) EXPECT_TRUE(std::isfinite(x));
  EXPECT_GT(energy(left, 10, kRows), 0.5 * energy(rows(kStart, 2), 10, kRows));
}

TEST(UnknownPast, ContinuesFromItsState) {
  const double hz = 1.5;
  std::vector<double> all = rows(kStart, hz), again = all;
  UnknownPast past = past_of(hz), later(kStride, 1, kShapes);
  for (std::size_t t = 0; t < kRows; ++t) past.remove(&all[t * kStride]);
  UnknownPast first = past_of(hz);
  for (std::size_t t = 0; t < kRows; ++t) {
    if (t == 150) {
      StateWriter state;
      state(first);
      const std::vector<std::uint8_t> bytes = state.bytes();
      StateReader reader(bytes);
      reader(later);
      ASSERT_TRUE(reader.whole());
    }
    (t < 150 ? first : later).remove(&again[t * kStride]);
  }
  EXPECT_EQ(all, again);
}

}  // namespace unknown_past_test
}  // namespace framewatch::estimator
