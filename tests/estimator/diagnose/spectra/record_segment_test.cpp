// SPDX-License-Identifier: MIT
#include "estimator/diagnose/spectra/record_segment.h"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "estimator/diagnose/spectra/fourier.h"
#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace record_segment_test {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr double kRate_hz = 50;
constexpr Index kIntervals = 1000;  // 20 s, without a prime factor above 5
constexpr double kStep_hz = kRate_hz / kIntervals;
constexpr Band kBand{1, 6};
constexpr double kRounding = 1e-9;

/// Returns a cosine with a whole number of periods in the segment, equal at both ends.
MatrixXd tone(Index bin, double amplitude, double phase, double mean) {
  MatrixXd out(kIntervals + 1, 1);
  for (Index i = 0; i < out.rows(); ++i)
    out(i, 0) =
        mean + amplitude * std::cos(2 * M_PI * static_cast<double>(bin * i) / kIntervals + phase);
  return out;
}

MatrixXd white(Index rows, Index axes, double sd, std::uint64_t seed) {
  Random random(seed);
  MatrixXd out(rows, axes);
  for (Index i = 0; i < out.size(); ++i) out.data()[i] = sd * random.normal();
  return out;
}

RecordSegment segment_of(const MatrixXd& accel, const Band& band = kBand) {
  return make_segment(accel, kRate_hz, VectorXd::Ones(accel.cols()), band);
}

TEST(RecordSegmentSpectrum, PutsAToneIntoItsBin) {
  constexpr Index kBin = 50;
  constexpr double kAmplitude = 0.7, kPhase = 0.3, kMean = 5;
  const RecordSegment s = segment_of(tone(kBin, kAmplitude, kPhase, kMean));
  VectorXcd expected = VectorXcd::Zero(s.bins());
  expected[kBin - s.first_bin] = std::polar(kAmplitude * kIntervals / 2, kPhase);
  // The mean includes the last, repeated sample: it lies below the band.
  EXPECT_LT((s.spectrum.row(0).transpose() - expected).norm(), kRounding * kIntervals);
  EXPECT_NEAR(s.accel.mean(), 0, kRounding);
}

TEST(RecordSegmentSpectrum, CoversTheBinsOfTheBand) {
  struct Case {
    Band band;
    Index first, last;
  };
  constexpr Index kHighest = (kIntervals - 1) / 2;
  for (const Case& c : {Case{{1, 6}, 20, 120}, Case{{1.01, 5.99}, 21, 119}, Case{{0, 0.2}, 1, 4},
                        Case{{20, 1000}, 400, kHighest}, Case{{2, 2}, 40, 40}}) {
    const RecordSegment s = segment_of(white(kIntervals + 1, 2, 1, 1), c.band);
    EXPECT_EQ(s.first_bin, c.first);
    ASSERT_EQ(s.bins(), c.last - c.first + 1);
    EXPECT_EQ(s.spectrum.cols(), s.bins());
    EXPECT_NEAR(s.w[0], 2 * M_PI * kStep_hz * static_cast<double>(c.first), kRounding);
    EXPECT_NEAR(s.w[s.bins() - 1], 2 * M_PI * kStep_hz * static_cast<double>(c.last), kRounding);
  }
}

TEST(RecordSegmentSpectrum, IsEmptyWithoutSamplesOrBand) {
  for (const Band& band : {Band{5, 2}, Band{24.999, 30}, Band{1.001, 1.002}})
    EXPECT_EQ(segment_of(white(kIntervals + 1, 2, 1, 1), band).bins(), 0);
  for (const Index rows : {1, 2, 3}) {
    const RecordSegment s = segment_of(white(rows, 2, 1, 1));
    EXPECT_EQ(s.bins(), 0) << rows;
    EXPECT_EQ(s.accel.rows(), rows);
  }
}

TEST(RecordSegmentSpectrum, IsCutToAFastLength) {
  const RecordSegment s = segment_of(white(kIntervals + 8, 2, 1, 1));
  EXPECT_EQ(s.intervals(), kIntervals);
  EXPECT_DOUBLE_EQ(s.seconds(), kIntervals / kRate_hz);
}

TEST(RecordSegmentSpectrum, CountsFirstAndLastSampleHalf) {
  MatrixXd ends = MatrixXd::Zero(kIntervals + 1, 1);
  ends(0, 0) = 3;
  ends(kIntervals, 0) = 1;
  const RecordSegment s = segment_of(ends);
  EXPECT_LT((s.spectrum.array() - 2.0).matrix().norm(), kRounding * kIntervals);
}

TEST(RecordSegmentSpectrum, RemovesTheSameMeanFromTheLead) {
  constexpr Index kLead = 130;
  const MatrixXd record = white(kLead + kIntervals + 1, 3, 1, 2);
  const RecordSegment s = make_segment(record, kRate_hz, VectorXd::Ones(3), kBand, {}, kLead);
  const RecordSegment alone = segment_of(record.bottomRows(kIntervals + 1));
  EXPECT_EQ(s.accel, alone.accel);
  EXPECT_EQ(s.spectrum, alone.spectrum);
  ASSERT_EQ(s.lead.rows(), kLead);
  const Eigen::RowVectorXd mean = record.bottomRows(kIntervals + 1).colwise().mean();
  EXPECT_LT((s.lead - (record.topRows(kLead).rowwise() - mean)).norm(), kRounding);
}

TEST(RecordSegmentSpectrum, ConvertsADisplacementToAcceleration) {
  constexpr Index kBin = 60;
  MatrixXd record(kIntervals + 1, 2);
  record << tone(kBin, 1, 0, 0), tone(kBin, 1, 0, 0);
  const RecordSegment s = make_segment(record, kRate_hz, VectorXd::Ones(2), kBand, {false, true});
  EXPECT_FALSE(s.is_displaced(0));
  EXPECT_TRUE(s.is_displaced(1));
  EXPECT_FALSE(s.is_displaced(2));
  const Index at = kBin - s.first_bin;
  EXPECT_LT(std::abs(s.spectrum(1, at) + s.w[at] * s.w[at] * s.spectrum(0, at)),
            kRounding * kIntervals * s.w[at] * s.w[at]);
}

TEST(RecordSegmentNoise, IsGivenOrEstimatedFromTheRecord) {
  constexpr double kGiven = 0.25, kTolerance = 0.2;
  constexpr Index kLong = 6000;
  const VectorXd sd = Eigen::Vector2d(kGiven, 0);
  MatrixXd record(kLong + 1, 2);
  record << white(kLong + 1, 1, 1, 3), white(kLong + 1, 1, 0.02, 4);
  const RecordSegment s = make_segment(record, kRate_hz, sd, kBand);
  EXPECT_DOUBLE_EQ(s.variance[0], kGiven * kGiven);
  EXPECT_NEAR(std::sqrt(s.variance[1]) / 0.02, 1, kTolerance);
}

TEST(RecordSegmentNoise, WhiteNoiseHasItsVarianceAtEveryRate) {
  // The correction for the quietest fifth is rough if a second has few frequencies.
  constexpr double kSd = 0.03, kTolerance = 0.15, kOfFewFrequencies = 0.25;
  for (const double rate_hz : {50.0, 100.0, 128.0, 200.0}) {
    const auto samples = static_cast<Index>(60 * rate_hz);
    const VectorXd noise = white(samples, 1, kSd, 5).col(0);
    for (const double low : {0.20, 0.40})
      EXPECT_NEAR(std::sqrt(quiet_noise_variance(noise, rate_hz, low)) / kSd, 1,
                  low < 0.3 ? kTolerance : kOfFewFrequencies)
          << rate_hz << " " << low;
  }
}

TEST(RecordSegmentNoise, HasALowerBound) {
  const double least = quiet_noise_variance(VectorXd::Zero(1000), kRate_hz);
  EXPECT_GT(least, 0);
  EXPECT_LT(least, 1e-12);
  EXPECT_EQ(quiet_noise_variance(white(20, 1, 1, 6).col(0), kRate_hz), least);
  EXPECT_EQ(quiet_noise_variance(VectorXd(), kRate_hz), least);
}

TEST(RecordSegmentSignal, FinerSamplesLieOnTheSameTone) {
  constexpr Index kBin = 77;
  constexpr double kAmplitude = 1.5, kPhase = -0.9;
  const RecordSegment s = segment_of(tone(kBin, kAmplitude, kPhase, 0));
  for (const int ratio : {1, 2, 5}) {
    const VectorXd fine = signal_of(s.spectrum.row(0).transpose(), s, ratio);
    ASSERT_EQ(fine.size(), kIntervals * ratio);
    for (Index i = 0; i < fine.size(); ++i)
      ASSERT_NEAR(fine[i],
                  kAmplitude * std::cos(2 * M_PI * static_cast<double>(kBin * i) /
                                            static_cast<double>(fine.size()) +
                                        kPhase),
                  1e-9)
          << ratio << " " << i;
  }
}

TEST(RecordSegmentSignal, HasNothingOutsideTheBand) {
  const RecordSegment s = segment_of(white(kIntervals + 1, 1, 1, 7));
  VectorXcd all = forward_fourier(signal_of(s.spectrum.row(0).transpose(), s, 1));
  all.segment(s.first_bin, s.bins()).setZero();
  EXPECT_LT(all.norm(), kRounding * kIntervals);
}

}  // namespace record_segment_test
}  // namespace framewatch::estimator
