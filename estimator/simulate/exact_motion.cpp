#include "estimator/simulate/exact_motion.h"

#include <cmath>

#include "estimator/simulate/linear_building.h"

namespace framewatch::estimator {
namespace {

constexpr double kLongestStep_s = 1e-3;

}  // namespace

MotionHistory exact_motion(const Structure& structure, const ParameterTable& table,
                           const Eigen::VectorXd& theta, const PlanMotion& motion, double rate_hz,
                           Eigen::Index rows) {
  const int ratio = static_cast<int>(std::ceil(1 / (rate_hz * kLongestStep_s) - 1e-9));
  const double step_s = 1 / (rate_hz * ratio);
  const auto ground = [&](Eigen::Index step) {
    const double t = static_cast<double>(step) * step_s;
    return Eigen::Vector2d(motion.x.at(t), motion.y.at(t));
  };
  LinearBuilding building(structure, table, theta, step_s);
  const Eigen::Index columns = structure.degrees_of_freedom();
  MotionHistory out{Eigen::MatrixXd(rows, columns), Eigen::MatrixXd(rows, columns),
                    Eigen::MatrixXd(rows, columns)};
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index k = (i - 1) * ratio; i > 0 && k < i * ratio; ++k)
      building.advance(ground(k), ground(k + 1));
    out.accel_abs.row(i) = building.accel_abs().transpose();
    out.vel_rel.row(i) = building.vel_rel().transpose();
    out.disp_rel.row(i) = building.disp_rel().transpose();
  }
  return out;
}

}  // namespace framewatch::estimator
