// SPDX-License-Identifier: MIT
#include "estimator/identify/noise/axis_noise.h"

#include <algorithm>
#include <limits>

namespace framewatch::estimator {
namespace {

constexpr double kChanged = 2;
constexpr double kMin = 1e-3;  // share of the noisiest axis: every axis has some noise

}  // namespace

AxisNoise::AxisNoise(const std::vector<SensorAxis>& axes, double rate_hz)
    : configured_(true), meter_(static_cast<int>(axes.size()), rate_hz) {
  for (const SensorAxis& axis : axes) {
    given_.push_back(axis.noise_density);
    configured_ = configured_ && axis.noise_density > 0;
  }
}

bool AxisNoise::densities(std::vector<double>& out) const {
  for (std::size_t a = 0; a < given_.size(); ++a)
    if (!(given_[a] > 0) && !(meter_.density(static_cast<int>(a)) > 0)) return false;
  double largest = 0;
  for (std::size_t a = 0; a < given_.size(); ++a) {
    out[a] = given_[a] > 0 ? given_[a] : meter_.density(static_cast<int>(a));
    largest = std::max(largest, out[a]);
  }
  for (double& density : out) density = std::max(density, kMin * largest);
  return true;
}

bool AxisNoise::differs(const std::vector<double>& now, const std::vector<double>& used) const {
  double lowest = std::numeric_limits<double>::infinity(), highest = 0;
  for (std::size_t a = 0; a < given_.size(); ++a) {
    if (given_[a] > 0) continue;
    lowest = std::min(lowest, now[a] / used[a]);
    highest = std::max(highest, now[a] / used[a]);
  }
  return highest > kChanged * lowest;
}

}  // namespace framewatch::estimator
