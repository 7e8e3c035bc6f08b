// SPDX-License-Identifier: MIT
#include "estimator/motion/svd_denoise.h"

#include <cmath>

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"

namespace framewatch::estimator {
namespace svd_denoise_test {

constexpr double kRounding = 1e-12;
constexpr SvdDenoising kPaper;

/// A motion that repeats in every interval has one singular value.
Eigen::VectorXd periodic(Eigen::Index size) {
  Eigen::VectorXd out(size);
  for (Eigen::Index i = 0; i < size; ++i)
    out[i] = std::sin(2 * M_PI * 3 * static_cast<double>(i) / kPaper.interval_rows);
  return out;
}

Eigen::VectorXd noise(Eigen::Index size, double rms) {
  Random random(5);
  Eigen::VectorXd out(size);
  for (double& value : out) value = rms * random.normal();
  return out;
}

TEST(SvdDenoise, UsesThePapersNumbers) {
  EXPECT_EQ(kPaper.interval_rows, 200);
  EXPECT_EQ(kPaper.intervals, 5);
  EXPECT_EQ(kPaper.norm_ratio, 0.98);
}

TEST(SvdDenoise, LeavesAMotionOfOneSingularValueAlone) {
  const Eigen::VectorXd motion = periodic(1000);
  EXPECT_LT((svd_denoised(motion) - motion).cwiseAbs().maxCoeff(), kRounding);
}

TEST(SvdDenoise, RemovesMostNoiseFromSuchAMotion) {
  // One of five singular directions remains: a fifth of the noise's energy, and slightly more.
  constexpr double kLeft = 0.5;
  const Eigen::VectorXd motion = periodic(1000);
  const Eigen::VectorXd noisy = motion + noise(1000, 0.1);
  EXPECT_LT((svd_denoised(noisy) - motion).norm(), kLeft * (noisy - motion).norm());
}

TEST(SvdDenoise, KeepsTheShareOfTheNormItPromises) {
  const Eigen::VectorXd samples = noise(1000, 1);
  const double kept = svd_denoised(samples).norm() / samples.norm();
  EXPECT_GE(kept, kPaper.norm_ratio);
  EXPECT_LE(kept, 1 + kRounding);
  SvdDenoising coarse = kPaper;
  coarse.norm_ratio = 0.5;
  EXPECT_LT(svd_denoised(samples, coarse).norm(), 0.8 * samples.norm());
}

TEST(SvdDenoise, LastStretchEndsWithTheRecord) {
  SvdDenoising coarse = kPaper;
  coarse.norm_ratio = 0.7;
  const Eigen::VectorXd samples = noise(1300, 1);
  const Eigen::VectorXd out = svd_denoised(samples, coarse);
  ASSERT_EQ(out.size(), 1300);
  EXPECT_EQ(out.head(1000), svd_denoised(samples.head(1000), coarse));
  EXPECT_EQ(out.tail(300), svd_denoised(samples.tail(1000), coarse).tail(300));
}

TEST(SvdDenoise, SilenceStaysSilent) {
  EXPECT_EQ(svd_denoised(Eigen::VectorXd::Zero(1000)), Eigen::VectorXd::Zero(1000));
}

}  // namespace svd_denoise_test
}  // namespace framewatch::estimator
