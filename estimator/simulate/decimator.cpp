// SPDX-License-Identifier: MIT
#include "estimator/simulate/decimator.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace framewatch::estimator {
namespace {

constexpr double kStopDecibel = 80;
constexpr double kPassOfRate = 0.4;
constexpr double kStopOfRate = 0.6;

/// Modified Bessel function of the first kind, order 0, by its series.
double bessel_i0(double x) {
  double sum = 1;
  double term = 1;
  for (int k = 1; term > 1e-17 * sum; ++k) {
    term *= (x / (2 * k)) * (x / (2 * k));
    sum += term;
  }
  return sum;
}

int longest_half(const std::vector<DecimatorChannel>& channels) {
  std::size_t half = 0;
  for (const DecimatorChannel& c : channels) half = std::max(half, c.taps.size() / 2);
  return static_cast<int>(half);
}

}  // namespace

std::vector<double> anti_alias_taps(int ratio, double delay) {
  assert(ratio >= 1);
  const double transition = 2 * M_PI * (kStopOfRate - kPassOfRate) / ratio;
  const int half = static_cast<int>(std::ceil((kStopDecibel - 7.95) / (2.285 * transition) / 2));
  const double beta = 0.1102 * (kStopDecibel - 8.7);
  const double cutoff = 0.5 * (kPassOfRate + kStopOfRate) / ratio;
  const int reach = half + static_cast<int>(std::ceil(std::abs(delay)));
  std::vector<double> taps;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) {
    const double at = i - delay;
    const double place = at / (half + 1);
    const double angle = 2 * M_PI * cutoff * at;
    const double sinc = angle == 0 ? 1 : std::sin(angle) / angle;
    const double window = std::max(0.0, 1 - place * place);
    taps.push_back(window == 0 ? 0 : sinc * bessel_i0(beta * std::sqrt(window)));
    sum += taps.back();
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

Decimator::Decimator(std::vector<DecimatorChannel> channels, int columns)
    : channels_(std::move(channels)),
      delay_steps_(longest_half(channels_)),
      length_(2 * delay_steps_ + 1),
      ring_(RowMajor::Zero(columns, 2 * length_)),
      output_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(channels_.size()))) {
  for ([[maybe_unused]] const DecimatorChannel& c : channels_)
    assert(c.taps.size() % 2 == 1 && c.column >= 0 && c.column < columns);
}

void Decimator::push(const Eigen::VectorXd& fine) {
  newest_ = newest_ == 0 ? length_ - 1 : newest_ - 1;
  ring_.col(newest_) = fine;
  ring_.col(newest_ + length_) = fine;
}

const Eigen::VectorXd& Decimator::output() {
  for (std::size_t c = 0; c < channels_.size(); ++c) {
    const std::vector<double>& taps = channels_[c].taps;
    const int skipped = delay_steps_ - static_cast<int>(taps.size() / 2);
    const auto filtered = [&](int column) {
      const double* newest_first = ring_.data() + column * ring_.cols() + newest_ + skipped;
      double sum = 0;
      for (std::size_t i = 0; i < taps.size(); ++i) sum += taps[i] * newest_first[i];
      return sum;
    };
    double value = channels_[c].weight * filtered(channels_[c].column);
    for (const auto& [column, weight] : channels_[c].also) value += weight * filtered(column);
    output_[static_cast<Eigen::Index>(c)] = value;
  }
  return output_;
}

}  // namespace framewatch::estimator
