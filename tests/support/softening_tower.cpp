// SPDX-License-Identifier: MIT
#include "tests/support/softening_tower.h"

#include <cmath>

#include "daemon/tools/lab/few_sensors.h"

namespace framewatch::test {
namespace {

constexpr int kFine = 10;  // steps of 1 ms per instant
constexpr double kStep_s = 1e-3;
constexpr double kTowerGround_hz = 2.5, kTowerGroundDamping = 0.6, kTowerGround_mps2 = 1;
constexpr double kGroupsOff = 0.2, kStoriesOff = 0.05, kMassesOff = 0.02;
constexpr double kMeasured_s = 60, kBuildUp_s = 15;

double within(estimator::Random& random, double most) {
  return most * (2 * random.uniform() - 1);
}

}  // namespace

SofteningTower::SofteningTower(std::uint64_t seed, double softening, double noise_ratio)
    : random_(seed), mass_(kStories), softening_(0) {
  const std::vector<int> floors{5, 10, 15, 20};
  config_.structure = daemon::tall_building(kStories);
  config_.design = daemon::tall_design(kStories);
  config_.axes = daemon::floor_axes(floors);
  config_.options.rate_hz = kRate_hz;
  stiffness_ = config_.design.head(kStories);
  damping_ = config_.design.tail(kStories);
  double group = 0;
  for (int story = 0; story < kStories; ++story) {
    if (story % 5 == 0) group = within(random_, kGroupsOff);
    const double factor = (1 + group) * std::exp(kStoriesOff * random_.normal());
    stiffness_[story] *= factor;
    damping_[story] *= factor;
    mass_[story] = config_.structure.node_mass[static_cast<std::size_t>(story)] *
                   std::exp(kMassesOff * random_.normal());
  }
  moved_ = velocity_ = level_ = usual_ = Eigen::ArrayXd::Zero(kStories);
  std::vector<estimator::DecimatorChannel> channels;
  const std::vector<double> taps = estimator::anti_alias_taps(kFine);
  for (std::size_t a = 0; a < config_.axes.size(); ++a)
    channels.push_back({static_cast<int>(a), taps});
  decimator_ = std::make_unique<estimator::Decimator>(channels, static_cast<int>(channels.size()));
  const auto axes = static_cast<Eigen::Index>(channels.size());
  fine_ = sigma_ = out_ = Eigen::VectorXd::Zero(axes);
  measure_noise();
  sigma_ *= noise_ratio;
  softening_ = softening;
  for (Eigen::Index a = 0; a < axes; ++a)
    config_.axes[static_cast<std::size_t>(a)].noise_density = sigma_[a] / std::sqrt(kRate_hz / 2);
}

/// Measures the rms of channels and drifts under shaking of level 1; returns to rest.
void SofteningTower::measure_noise() {
  Eigen::ArrayXd squares = Eigen::ArrayXd::Zero(sigma_.size()), drifts = usual_;
  const auto instants = static_cast<int>(kMeasured_s * kRate_hz);
  for (int i = -static_cast<int>(kBuildUp_s * kRate_hz); i < instants; ++i) {
    next(1);
    if (i < 0) continue;
    squares += out_.array().square() / instants;
    drifts += level_ / instants;
  }
  sigma_ = squares.sqrt().matrix();
  usual_ = drifts;
  moved_.setZero(), velocity_.setZero(), level_.setZero();
  ground_moved_ = ground_velocity_ = 0;
}

const Eigen::VectorXd& SofteningTower::next(double level) {
  for (int i = 0; i < kFine; ++i) step(level);
  out_ = decimator_->output();
  for (Eigen::Index a = 0; a < out_.size(); ++a) out_[a] += sigma_[a] * random_.normal();
  return out_;
}

void SofteningTower::step(double level) {
  const double w = 2 * M_PI * kTowerGround_hz;
  const double white = kTowerGround_mps2 * level *
                       std::sqrt(2 * kTowerGroundDamping / w / kStep_s) * random_.normal();
  const double pull = 2 * kTowerGroundDamping * w * ground_velocity_ + w * w * ground_moved_;
  ground_velocity_ += kStep_s * (white - pull);
  ground_moved_ += kStep_s * ground_velocity_;
  const double ground = -(2 * kTowerGroundDamping * w * ground_velocity_ + w * w * ground_moved_);

  double below = 0, below_velocity = 0, lower = 0;
  Eigen::Array<double, kStories, 1> accel;  // relative to the ground
  for (int s = 0; s < kStories; ++s) {
    const double drift = moved_[s] - below, rate = velocity_[s] - below_velocity;
    const double rms = std::sqrt(level_[s]);
    const double soft = softening_ > 0 ? 1 - softening_ * rms / (rms + std::sqrt(usual_[s])) : 1.0;
    const double force = soft * stiffness_[s] * drift + damping_[s] * rate;
    const double square = drift * drift;
    level_[s] += kStep_s / (square > level_[s] ? kRise_s : kFall_s) * (square - level_[s]);
    if (s > 0) accel[s - 1] = (force - lower) / mass_[s - 1] - ground;
    lower = force;
    below = moved_[s], below_velocity = velocity_[s];
  }
  accel[kStories - 1] = -lower / mass_[kStories - 1] - ground;
  velocity_ += kStep_s * accel;
  moved_ += kStep_s * velocity_;
  fine_[0] = ground;
  for (Eigen::Index a = 1; a < fine_.size(); ++a)
    fine_[a] = ground + accel[config_.axes[static_cast<std::size_t>(a)].story - 1];
  decimator_->push(fine_);
}

}  // namespace framewatch::test
