// SPDX-License-Identifier: MIT
#include "tests/support/restless_building.h"

#include <cmath>

namespace framewatch::test {
namespace {

constexpr int kSteps = 2;  // per sample
constexpr double kStepRate_hz = kSteps * RestlessBuilding::kRate_hz;
constexpr double kGround_hz = 2.5, kGroundDamping = 0.6, kHighPass_hz = 0.3, kLowPass_hz = 25;

}  // namespace

RestlessBuilding::RestlessBuilding(const estimator::Structure& structure,
                                   const Eigen::VectorXd& theta,
                                   const std::vector<estimator::SensorAxis>& axes,
                                   std::uint64_t seed)
    : building_(structure, estimator::ParameterTable(structure), theta, 1 / kStepRate_hz),
      random_(seed),
      measured_(static_cast<Eigen::Index>(axes.size())) {
  // s^2 / (s^2 + 2 z w s + w^2), (2 z w s + w^2) / (same) and w^2 / (same), bilinear.
  const auto section = [](double hz, double z, double n2, double n1, double n0) {
    const double w = std::tan(M_PI * hz / kStepRate_hz);
    const double d = 1 + 2 * z * w + w * w;
    const double second = n2, first = n1 * 2 * z * w, zeroth = n0 * w * w;
    return Section{(second + first + zeroth) / d, 2 * (zeroth - second) / d,
                   (second - first + zeroth) / d, 2 * (w * w - 1) / d, (1 - 2 * z * w + w * w) / d};
  };
  sections_ = {section(kGround_hz, kGroundDamping, 0, 1, 1),
               section(kHighPass_hz, M_SQRT1_2, 1, 0, 0), section(kLowPass_hz, M_SQRT1_2, 0, 0, 1),
               section(kLowPass_hz, M_SQRT1_2, 0, 0, 1)};
  const Eigen::Index floors = structure.degrees_of_freedom();
  for (const estimator::SensorAxis& axis : axes)
    sensed_.push_back(axis.story > 0 ? structure.dof(axis.story, axis.frame)
                      : axis.direction == estimator::Direction::x ? floors
                                                                  : floors + 1);
}

double RestlessBuilding::Section::through(double x, int direction) {
  const double y = b0 * x + s1[direction];
  s1[direction] = b1 * x - a1 * y + s2[direction];
  s2[direction] = b2 * x - a2 * y;
  return y;
}

Eigen::Vector2d RestlessBuilding::ground() {
  const double gain = ground_density_ * std::sqrt(kStepRate_hz / 2);
  Eigen::Vector2d out;
  for (int direction = 0; direction < 2; ++direction) {
    double x = gain * random_.normal();
    for (Section& section : sections_) x = section.through(x, direction);
    out[direction] = x;
  }
  return out;
}

const Eigen::VectorXd& RestlessBuilding::next() {
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::Vector2d now = ground();
    building_.advance(before_, now);
    before_ = now;
  }
  const Eigen::VectorXd& floors = building_.accel_abs();
  const double sigma = noise_density_ * std::sqrt(kRate_hz / 2);
  for (std::size_t a = 0; a < sensed_.size(); ++a)
    measured_[static_cast<Eigen::Index>(a)] =
        sensed_[a] < floors.size() ? floors[sensed_[a]] : before_[sensed_[a] - floors.size()];
  for (double& value : measured_) value += sigma * random_.normal();
  return measured_;
}

}  // namespace framewatch::test
