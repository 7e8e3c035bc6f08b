#include "tests/support/noisy_stretch.h"

#include <cmath>

#include "estimator/simulate/linear_response.h"
#include "estimator/simulate/random.h"
#include "estimator/structure/parameter_table.h"
#include "tests/support/paper_buildings.h"

namespace framewatch::test {
namespace {

constexpr double kRate_hz = 100;
constexpr double kWhole_s = 15;

}  // namespace

ExactStretch exact_stretch(const Structure& structure, const Eigen::VectorXd& truth,
                           const PlanMotion& motion, double noise_ratio, double from_s,
                           double to_s) {
  const Response response =
      linear_response(structure, ParameterTable(structure), truth, motion, {}, kWhole_s);
  const auto first = static_cast<Eigen::Index>(std::llround(from_s * kRate_hz));
  const auto last = static_cast<Eigen::Index>(std::llround(to_s * kRate_hz));
  ExactStretch out{full_sensor_axes(structure),
                   response.accel_abs.middleRows(first, last - first + 1)};
  for (std::size_t a = 0; a < out.axes.size(); ++a) {
    const double rms =
        std::sqrt(response.accel_abs.col(static_cast<Eigen::Index>(a)).array().square().mean());
    out.axes[a].noise_density = noise_ratio * rms / std::sqrt(kRate_hz / 2);
  }
  return out;
}

Eigen::MatrixXd with_noise(const ExactStretch& stretch, std::uint64_t seed) {
  Random random(seed);
  Eigen::MatrixXd out = stretch.accel_abs;
  for (Eigen::Index a = 0; a < out.cols(); ++a) {
    const double sigma =
        stretch.axes[static_cast<std::size_t>(a)].noise_density * std::sqrt(kRate_hz / 2);
    for (Eigen::Index i = 0; i < out.rows(); ++i) out(i, a) += sigma * random.normal();
  }
  return out;
}

PlanMotion oblique_motion(std::uint64_t seed) {
  KanaiTajimi motion;
  motion.duration_s = kWhole_s;
  motion.seed = seed;
  return directed(kanai_tajimi(motion), M_PI / 4);
}

}  // namespace framewatch::test
