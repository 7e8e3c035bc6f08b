#include "daemon/tools/lab/paper_method.h"

#include <cmath>
#include <numbers>

#include "estimator/motion/svd_denoise.h"
#include "estimator/simulate/random.h"

namespace framewatch::daemon {
namespace {

constexpr double kLow_hz = 0.075 / (2 * std::numbers::pi);
constexpr double kHigh_hz = 150 / (2 * std::numbers::pi);

void add_noise(Eigen::MatrixXd& channels, double rate_hz, double ratio, estimator::Random random) {
  for (auto channel : channels.colwise()) {
    const double rms = std::sqrt(channel.squaredNorm() / static_cast<double>(channel.size()));
    channel += ratio * rms * band_noise(channel.size(), rate_hz, kLow_hz, kHigh_hz, random);
  }
}

}  // namespace

estimator::MotionHistory with_paper_noise(const estimator::MotionHistory& exact, double rate_hz,
                                          double noise_ratio, std::uint64_t seed) {
  estimator::MotionHistory out = exact;
  if (noise_ratio <= 0) return out;
  add_noise(out.accel_abs, rate_hz, noise_ratio, estimator::Random(seed, 0));
  add_noise(out.vel_rel, rate_hz, noise_ratio, estimator::Random(seed, 1));
  add_noise(out.disp_rel, rate_hz, noise_ratio, estimator::Random(seed, 2));
  return out;
}

estimator::MotionHistory denoised(const estimator::MotionHistory& noisy) {
  estimator::MotionHistory out = noisy;
  for (Eigen::MatrixXd* channels : {&out.accel_abs, &out.vel_rel, &out.disp_rel})
    for (auto channel : channels->colwise()) channel = estimator::svd_denoised(channel);
  return out;
}

}  // namespace framewatch::daemon
