#include "estimator/diagnose/fit/linearised.h"

#include <algorithm>
#include <numeric>

#include "estimator/numeric/solve.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void put_rows(const Linearised& at, std::size_t record, const std::vector<Index>& kept, Index bin,
              Eigen::Block<RowMatrix> out) {
  const Whitened& system = at.systems[record];
  const Index rows = out.rows(), count = static_cast<Index>(kept.size());
  for (Index i = 0; i < rows; ++i) {
    const double* from = &at.columns[record](rows * bin + i, 0);
    double* to = &out(i, 0);
    for (Index u = 0; u < count; ++u) to[u] = from[kept[static_cast<std::size_t>(u)]];
  }
  out.rightCols(1) = system.residual.segment(rows * bin, rows);
}

MatrixXd square_of(const Linearised& at, std::size_t record, const std::vector<Index>& kept) {
  const Whitened& system = at.systems[record];
  const Weights& weights = *system.weights;
  const Index own = static_cast<Index>(kept.size()) + 1, ends = weights.ends();
  RowGram gram(own);
  AlongEnds along(weights);
  for (Index b = 0; b < system.bins(); ++b) {
    put_rows(at, record, kept, b, gram.rows(2 * weights.equations()));
    gram.add();
    along.add(b, gram.written());
  }
  MatrixXd out(own + ends, own + ends);
  out.topLeftCorner(own, own) = gram.sum();
  out.bottomLeftCorner(ends, own) = along.sum().leftCols(own);
  out.topRightCorner(own, ends) = along.sum().leftCols(own).transpose();
  out.bottomRightCorner(ends, ends) = weights.ends_square();
  return out;
}

NormalEquations without_ends(const MatrixXd& square, Index ends) {
  const Index count = square.cols() - ends - 1;
  MatrixXd inner = square.bottomRightCorner(ends, ends);
  inner.diagonal().array() += 1e-9;
  const Ldlt factor(inner);
  const MatrixXd cross = square.topRightCorner(count, ends);
  const VectorXd last = square.row(count).tail(ends).transpose();
  const VectorXd solved = factor.solve(last);
  NormalEquations out;
  out.normal = square.topLeftCorner(count, count) - cross * factor.solve_transposed(cross);
  out.gradient = square.col(count).head(count) - cross * solved;
  out.misfit = square(count, count) - last.dot(solved);
  return out;
}

VectorXd bounded_step(const MatrixXd& normal, const VectorXd& right, const Model& model,
                      const std::vector<Unknown>& unknowns) {
  VectorXd step = Ldlt(normal).solve(right);
  std::vector<char> held(unknowns.size(), 0);
  VectorXd to_bound = VectorXd::Zero(right.size());
  for (bool more = step.allFinite(); more;) {
    more = false;
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      const Unknown& u = unknowns[i];
      const auto at = static_cast<Index>(i);
      const double from = value_of(model, u), to = from + step[at];
      if (held[i] || (to >= u.low && to <= u.high)) continue;
      held[i] = true;
      to_bound[at] = std::clamp(to, u.low, u.high) - from;
      more = true;
    }
    if (!more) break;
    MatrixXd rest = normal;
    VectorXd left = right - normal * to_bound;
    for (std::size_t i = 0; i < held.size(); ++i) {
      if (!held[i]) continue;
      const auto at = static_cast<Index>(i);
      rest.row(at).setZero();
      rest.col(at).setZero();
      rest(at, at) = 1;
      left[at] = to_bound[at];
    }
    step = Ldlt(rest).solve(left);
    more = step.allFinite();
  }
  return step;
}

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  normal += other.normal;
  gradient += other.gradient;
  misfit += other.misfit;
  return *this;
}

NormalEquations normal_equations(const Linearised& at) {
  std::vector<Index> all(at.unknowns.size());
  std::iota(all.begin(), all.end(), Index{0});
  const auto count = static_cast<Index>(all.size());
  NormalEquations out{MatrixXd::Zero(count, count), VectorXd::Zero(count), 0};
  for (std::size_t r = 0; r < at.systems.size(); ++r)
    out += without_ends(square_of(at, r, all), at.systems[r].weights->ends());
  return out;
}

}  // namespace framewatch::estimator
