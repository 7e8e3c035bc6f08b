#include "estimator/simulate/decimator.h"

#include <cassert>
#include <cmath>
#include <utility>

namespace framewatch {
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

}  // namespace

std::vector<double> anti_alias_taps(int ratio) {
  assert(ratio >= 1);
  const double transition = 2 * M_PI * (kStopOfRate - kPassOfRate) / ratio;
  const int half = static_cast<int>(std::ceil((kStopDecibel - 7.95) / (2.285 * transition) / 2));
  const double beta = 0.1102 * (kStopDecibel - 8.7);
  const double cutoff = 0.5 * (kPassOfRate + kStopOfRate) / ratio;
  std::vector<double> taps;
  double sum = 0;
  for (int i = -half; i <= half; ++i) {
    const double place = static_cast<double>(i) / (half + 1);
    const double angle = 2 * M_PI * cutoff * i;
    const double sinc = i == 0 ? 1 : std::sin(angle) / angle;
    taps.push_back(sinc * bessel_i0(beta * std::sqrt(1 - place * place)));
    sum += taps.back();
  }
  for (double& tap : taps) tap /= sum;
  return taps;
}

Decimator::Decimator(std::vector<double> taps, int channels)
    : taps_(std::move(taps)),
      ring_(Eigen::MatrixXd::Zero(channels, static_cast<Eigen::Index>(taps_.size()))),
      output_(Eigen::VectorXd::Zero(channels)) {
  assert(taps_.size() % 2 == 1);
}

void Decimator::push(const Eigen::VectorXd& fine) {
  newest_ = (newest_ + 1) % static_cast<int>(taps_.size());
  ring_.col(newest_) = fine;
}

const Eigen::VectorXd& Decimator::output() {
  output_.setZero();
  int at = newest_;
  for (const double tap : taps_) {
    const double* column = ring_.data() + ring_.rows() * at;
    for (Eigen::Index c = 0; c < ring_.rows(); ++c) output_.data()[c] += tap * column[c];
    at = at == 0 ? static_cast<int>(taps_.size()) - 1 : at - 1;
  }
  return output_;
}

}  // namespace framewatch
