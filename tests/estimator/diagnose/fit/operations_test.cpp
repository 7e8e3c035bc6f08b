#include "estimator/diagnose/fit/whitened.h"

#include <gtest/gtest.h>

#include "estimator/simulate/random.h"
#include "tests/estimator/diagnose/exact_record.h"

namespace framewatch::estimator {
namespace operations_test {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using test::effect_of;

constexpr double kRounding = 1e-12;
constexpr Index kEquations = 4, kAxes = 6;

/// Products of all bins at once are those of the operation of each, kept or made anew.
TEST(Operations, MultiplyAllBinsAtOnce) {
  const test::Small small;
  const Plant plant = small.plant();
  const Model model = test::true_model(small, plant);
  ASSERT_EQ(plant.equations(), kEquations);
  ASSERT_EQ(plant.axis_count(), kAxes);
  Random random(3);
  const auto some = [&](Index rows, Index columns) {
    return MatrixXd(MatrixXd::NullaryExpr(rows, columns, [&] { return random.normal(); }));
  };
  const MatrixXd mass = some(kEquations, kAxes), stiffness = 50 * some(kEquations, kAxes),
                 damping = some(kEquations, kAxes);
  const EffectPlace node = test::node_place(2);
  const LinearOperation resonator(plant, model,
                                  effect_of(LawForm::resonator, node, {2, 1.5, 0.05}));
  const LinearOperation damper(plant, model, effect_of(LawForm::damper, node, {30}));
  for (const Index bins : {Index{7}, Index{50000}}) {
    const Eigen::VectorXd w = Eigen::VectorXd::LinSpaced(bins, 3, 40);
    const Operations operations(mass, stiffness, damping, {resonator, damper}, w);
    MatrixXcd motion(kAxes, bins), forces(kEquations, bins);
    motion.real() = some(kAxes, bins);
    motion.imag() = some(kAxes, bins);
    forces.real() = some(kEquations, bins);
    forces.imag() = some(kEquations, bins);
    const MatrixXcd times = operations.times(motion), back = operations.adjoint_times(forces),
                    axis = operations.of_axis(3);
    for (const Index b : {Index{0}, bins / 2, bins - 1}) {
      const MatrixXcd d = operations[static_cast<std::size_t>(b)];
      EXPECT_LT((times.col(b) - d * motion.col(b)).norm(), kRounding * d.norm());
      EXPECT_LT((back.col(b) - d.adjoint() * forces.col(b)).norm(), kRounding * d.norm());
      EXPECT_LT((axis.col(b) - d.col(3)).norm(), kRounding * d.norm());
    }
  }
  const Operations plain(mass, stiffness, damping, {}, Eigen::VectorXd::LinSpaced(50000, 3, 40));
  EXPECT_LT((plain.of_axis(2).col(9) - plain[9].col(2)).norm(), kRounding * plain[9].norm());
}

}  // namespace operations_test
}  // namespace framewatch::estimator
