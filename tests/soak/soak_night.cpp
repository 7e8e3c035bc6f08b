// SPDX-License-Identifier: MIT
#include "tests/soak/soak_night.h"

#include <algorithm>
#include <cmath>

#include "estimator/numeric/nan.h"

namespace framewatch::soak {
namespace {

constexpr double kRate_hz = test::RestlessBuilding::kRate_hz;
constexpr std::int64_t kStart_us = 1'795'305'600'000'000;  // 2026-11-22T00:00:00Z
constexpr std::int64_t kStep_us = 10'000;
constexpr double kDay_s = 86'400;
constexpr double kNight = 5e-5, kDay = 1.5e-4, kTraffic = 6, kQuake = 0.3;  // m/s^2/sqrt(Hz)
constexpr double kMean_degc = 10, kSwing_degc = 16;                         // trough to crest
constexpr std::int64_t kSeason = 100 * 300;                                 // instants
constexpr double kQuake_s = 40;
constexpr double kQuakes[] = {0.3, 0.7};  // shares of the duration, here and below
constexpr double kDeadFrom = 0.2, kDeadTo = 0.23, kStuckFrom = 0.5, kStuckTo = 0.51;
constexpr double kSpikes[] = {0.15, 0.35, 0.55};
struct ClockStep {
  double at;
  std::int64_t step_us;
};
constexpr ClockStep kClockSteps_[] = {{0.4, 300'000}, {0.6, -1'500'000}, {0.8, 3'600'000'000}};

}  // namespace

SoakNight::SoakNight(const estimator::PipelineConfig& config, std::int64_t instants,
                     std::uint64_t seed)
    : instants_(instants),
      truth_(config.design),
      parameters_stiff_(estimator::ParameterTable(config.structure).elements()),
      random_(seed, 1),
      building_(config.structure, config.design, config.axes, seed),
      accel_(config.axes.size()) {
  // The design differs from the building by a tenth, like one from drawings.
  for (Eigen::Index p = 0; p < truth_.size(); ++p) truth_[p] *= p % 2 == 0 ? 1.1 : 0.92;
  building_.set_noise(config.axes.front().noise_density);
}

void SoakNight::season() {
  const double day = 2 * M_PI * static_cast<double>(at_) / kRate_hz / kDay_s;
  degc_ = kMean_degc + kSwing_degc / 2 * std::sin(day);
  Eigen::VectorXd theta = truth_;
  theta.head(parameters_stiff_) *= 1 - kSwing / 2 * std::sin(day);
  building_.set_theta(theta);
}

void SoakNight::fail(std::vector<double>& accel) {
  if (within(kDeadFrom, kDeadTo)) accel[5] = estimator::kNaN;
  if (within(kStuckFrom, kStuckTo)) accel[3] = 0.01;
  for (const double at : kSpikes)
    if (at_ == static_cast<std::int64_t>(share(at))) accel[4] = 1000;
}

Instant SoakNight::next() {
  ++at_;
  if (at_ % kSeason == 0) season();
  if (at_ % 100 == 0) {
    const double day = 2 * M_PI * static_cast<double>(at_) / kRate_hz / kDay_s;
    double ground = kNight + (kDay - kNight) * std::pow(std::sin(day / 2), 2);
    if (burst_ > 0) --burst_;
    if (burst_ == 0 && random_.uniform() < 0.005)
      burst_ = 5 + static_cast<std::int64_t>(15 * random_.uniform());
    if (burst_ > 0) ground *= kTraffic;
    for (const double quake : kQuakes)
      if (static_cast<double>(at_) >= share(quake) &&
          static_cast<double>(at_) < share(quake) + kQuake_s * kRate_hz)
        ground = kQuake;
    building_.set_ground(ground);
  }
  const Eigen::VectorXd& measured = building_.next();
  std::copy(measured.begin(), measured.end(), accel_.begin());
  fail(accel_);
  for (const ClockStep& step : kClockSteps_)
    if (at_ == static_cast<std::int64_t>(share(step.at))) clock_us_ += step.step_us;
  return {kStart_us + kStep_us * at_ + clock_us_, &accel_};
}

}  // namespace framewatch::soak
