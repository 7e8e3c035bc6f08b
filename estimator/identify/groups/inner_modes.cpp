#include "estimator/identify/groups/inner_modes.h"

#include <algorithm>

#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

constexpr int kShapes = 24;    // modes of a large set
constexpr double kSpread = 3;  // hinges: factor that their stiffness may be off
constexpr double kIndependentShape = 1e-7;

Eigen::MatrixXd shapes_of(const InnerSet& set, int measured, double hinge_factor) {
  const Eigen::Index n = set.mass.rows();
  Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd coupling = Eigen::MatrixXd::Zero(n, measured);
  for (const InnerSpring& s : set.springs) {
    const double k = s.stiffness * (s.hinge ? hinge_factor : 1);
    for (const auto& [i, b] : s.deformation) {
      for (const auto& [j, d] : s.deformation) stiffness(i, j) += k * b * d;
      for (const auto& [j, d] : s.ends) coupling(i, j) += k * b * d;
    }
  }
  std::vector<Eigen::Index> moved;
  for (Eigen::Index j = 0; j < measured; ++j)
    if (!coupling.col(j).isZero(0)) moved.push_back(j);
  const RealEigen modes = generalized_eigen(set.mass, stiffness);  // ascending 1 / w^2
  const Eigen::Index kept = std::min<Eigen::Index>(kShapes, n);
  Eigen::MatrixXd out(n, kept + static_cast<Eigen::Index>(moved.size()));
  out.leftCols(kept) = modes.vectors.rightCols(kept);
  Eigen::MatrixXd ends(n, static_cast<Eigen::Index>(moved.size()));
  for (std::size_t i = 0; i < moved.size(); ++i)
    ends.col(static_cast<Eigen::Index>(i)) = coupling.col(moved[i]);
  out.rightCols(ends.cols()) = Cholesky(stiffness).solve(ends);
  for (Eigen::Index i = 0; i < out.cols(); ++i) out.col(i).normalize();
  return out;
}

}  // namespace

Eigen::MatrixXd inner_shapes(const InnerSet& set, int measured) {
  const Eigen::Index n = set.mass.rows();
  if (n <= kMaxInner) return Eigen::MatrixXd::Identity(n, n);
  const bool hinges = std::any_of(set.springs.begin(), set.springs.end(),
                                  [](const InnerSpring& s) { return s.hinge; });
  Eigen::MatrixXd all = shapes_of(set, measured, 1);
  for (const double factor : {1 / kSpread, kSpread}) {
    if (!hinges) break;
    const Eigen::MatrixXd more = shapes_of(set, measured, factor);
    all.conservativeResize(Eigen::NoChange, all.cols() + more.cols());
    all.rightCols(more.cols()) = more;
  }
  const SingularValues independent = singular_values(all);
  Eigen::Index kept = 0;
  while (kept < independent.values.size() &&
         independent.values[kept] > kIndependentShape * independent.values[0])
    ++kept;
  return independent.left.leftCols(kept);
}

}  // namespace framewatch::estimator
