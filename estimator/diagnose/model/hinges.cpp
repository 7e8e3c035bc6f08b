#include "estimator/diagnose/model/hinges.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include "estimator/numeric/solve.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd hinges(const Plant& plant, const ModelEffect& effect) {
  const Structure& s = plant.structure;
  const bool bending = effect.form == LawForm::bending;
  std::vector<VectorXd> rows;
  const auto along = static_cast<std::size_t>(effect.place.direction == Direction::x ? 0 : 1);
  const auto add = [&](int frame, int above) {
    VectorXd row = VectorXd::Zero(plant.element_count());
    for (const Element& e : plant.elements)
      if (e.frame >= 0 && s.direction(e.frame) == effect.place.direction &&
          (frame < 0 || e.frame == frame) && e.story > above)
        row[e.stiffness] = s.story_height[static_cast<std::size_t>(e.story - 1)];
    rows.push_back(row);
  };
  if (!bending) {
    add(-1, 0);
  } else {
    for (int f = 0; f < s.frames(); ++f)
      if (s.direction(f) == effect.place.direction)
        for (int j = 0; j < s.stories; ++j) {
          add(f, j);
          if (plant.bending[along] > 0)
            rows.back() *= std::sqrt(plant.bending[along] /
                                     plant.bending.of_floor(along, static_cast<std::size_t>(j)));
        }
  }
  MatrixXd out(static_cast<Index>(rows.size()), plant.element_count());
  for (std::size_t r = 0; r < rows.size(); ++r) out.row(static_cast<Index>(r)) = rows[r];
  return out;
}

HingedElements hinged_elements(const Plant& plant, const Model& model, const ModelEffect& effect) {
  // d = q - H' phi, (1/size) phi = H k d: size is the flexibility 1/K.
  const double size = effect.parameters[0].plain();
  const Index n = plant.element_count();
  const MatrixXd h = hinges(plant, effect);
  const VectorXd k = model.theta.head(n), c = model.theta.tail(n);
  const MatrixXd hk = h * k.asDiagonal();
  MatrixXd inner = size * hk * h.transpose();
  inner.diagonal().array() += 1;
  const MatrixXd turn = size * solve_lu(inner, hk);  // phi = turn q
  const MatrixXd kept = MatrixXd::Identity(n, n) - h.transpose() * turn;
  HingedElements out{k.asDiagonal() * kept, kept.transpose() * c.asDiagonal() * kept};
  out.stiffness.diagonal() -= k;
  out.damping.diagonal() -= c;
  return out;
}

}  // namespace framewatch::estimator
