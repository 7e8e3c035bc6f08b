#include "estimator/diagnose/locate/closer_look.h"

#include <cmath>

#include "estimator/numeric/complex.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr int kIterations = 4;

/// equations x directions of a list's places in one bin.
MatrixXcd directions_of(const std::vector<CandidatePlace>& places, const MatrixXcd& operation) {
  MatrixXcd out(operation.rows(), 0);
  for (const CandidatePlace& place : places) {
    const bool axis = place.kind == CandidatePlace::Kind::axis;
    const Index count = axis ? 1 : place.directions.cols();
    out.conservativeResize(Eigen::NoChange, out.cols() + count);
    if (axis)
      out.rightCols(1) = operation.col(place.axis);
    else
      out.rightCols(count) = place.directions.cast<Complex>();
  }
  return out;
}

/// Takes the part along `directions` off forces under the metric.
void project(const MatrixXcd& metric, const MatrixXcd& directions, VectorXcd& forces) {
  const MatrixXcd under = metric * directions;
  const VectorXcd along = directions.adjoint() * forces;
  if (directions.cols() == 1) {
    const double square = directions.col(0).dot(under.col(0)).real();
    if (square > 0) forces -= under.col(0) * (along[0] / square);
    return;
  }
  const VectorXcd size = solve_ldlt(directions.adjoint() * under, along);
  if (size.allFinite()) forces -= under * size;
}

/// The forces on the equations whose whitened rows are an effect's column in one bin.
VectorXcd effect_force(const Whitened& system, const Columns& columns, Index unknown, Index bin) {
  const Index n = system.operation.equations();
  const auto rows = columns.effects.col(columns.row[static_cast<std::size_t>(unknown)]);
  VectorXcd out(n);
  out.real() = rows.segment(2 * n * bin, n);
  out.imag() = rows.segment(2 * n * bin + n, n);
  return system.weights->forces_of(bin, out);
}

/// Curvature times x, a column a list, the signals of its places free.
MatrixXd curvature_times(const Linearised& at, const std::vector<Index>& kept,
                         const std::vector<std::vector<CandidatePlace>>& lists, const MatrixXd& x) {
  const Plant& plant = *at.plant;
  const Index elements = plant.element_count(), axes = plant.axis_count(), n = plant.equations();
  const MatrixXcd act = plant.building.act.cast<Complex>();
  MatrixXd out = MatrixXd::Zero(x.rows(), x.cols());
  for (std::size_t r = 0; r < at.systems.size(); ++r) {
    const Whitened& system = at.systems[r];
    const Columns& columns = at.columns[r];
    for (Index b = 0; b < system.bins(); ++b) {
      const MatrixXcd operation = system.operation[static_cast<std::size_t>(b)].leftCols(axes);
      const MatrixXcd metric = system.weights->metric(b);
      MatrixXcd along = MatrixXcd::Zero(elements + axes + n, x.cols());
      MatrixXcd forces = MatrixXcd::Zero(n, x.cols());
      for (Index i = 0; i < x.rows(); ++i) {
        const Index u = kept[static_cast<std::size_t>(i)];
        const Index d = columns.direction[static_cast<std::size_t>(u)];
        if (d >= 0)
          along.row(d) += columns.size(b, u) * x.row(i).cast<Complex>();
        else
          forces += effect_force(system, columns, u, b) * x.row(i).cast<Complex>();
      }
      forces.noalias() += act * along.topRows(elements);
      forces.noalias() += operation * along.middleRows(elements, axes);
      forces += along.bottomRows(n);
      MatrixXcd under = metric * forces;
      for (Index l = 0; l < x.cols(); ++l) {
        VectorXcd one = under.col(l);
        project(metric, directions_of(lists[static_cast<std::size_t>(l)], operation), one);
        under.col(l) = one;
      }
      along.topRows(elements).noalias() = act.transpose() * under;
      along.middleRows(elements, axes).noalias() = operation.adjoint() * under;
      along.bottomRows(n) = under;
      for (Index i = 0; i < x.rows(); ++i) {
        const Index u = kept[static_cast<std::size_t>(i)];
        const Index d = columns.direction[static_cast<std::size_t>(u)];
        if (d >= 0)
          out.row(i) += (std::conj(columns.size(b, u)) * along.row(d)).real();
        else
          out.row(i) += (effect_force(system, columns, u, b).adjoint() * under).real();
      }
    }
  }
  return out;
}

}  // namespace

std::vector<CloserLook> closer_looks(const Linearised& at, const std::vector<Index>& kept,
                                     const std::vector<std::vector<CandidatePlace>>& lists,
                                     const std::vector<NormalEquations>& equations) {
  const auto count = static_cast<Index>(kept.size()), width = static_cast<Index>(lists.size());
  VectorXd prior(count), pull(count);
  for (Index i = 0; i < count; ++i) {
    prior[i] = at.prior[kept[static_cast<std::size_t>(i)]] / at.level;
    pull[i] = at.pull[kept[static_cast<std::size_t>(i)]] / at.level;
  }
  std::vector<Ldlt> direct;
  MatrixXd right(count, width);
  for (Index l = 0; l < width; ++l) {
    const NormalEquations& own = equations[static_cast<std::size_t>(l)];
    MatrixXd normal = own.normal;
    normal.diagonal() += prior;
    normal.diagonal().array() += 1e-12 + 1e-9 * normal.diagonal().array();
    direct.emplace_back(normal);
    right.col(l) = pull - own.gradient;
  }
  const auto directed = [&](const MatrixXd& rest) {
    MatrixXd out(count, width);
    for (Index l = 0; l < width; ++l)
      out.col(l) = direct[static_cast<std::size_t>(l)].solve(VectorXd(rest.col(l)));
    return out;
  };
  MatrixXd x = MatrixXd::Zero(count, width), rest = right, z = directed(rest), p = z;
  Eigen::RowVectorXd rho = rest.cwiseProduct(z).colwise().sum();
  for (int i = 0; i < kIterations; ++i) {
    MatrixXd product = curvature_times(at, kept, lists, p);
    product += prior.asDiagonal() * p;
    const Eigen::RowVectorXd bend = p.cwiseProduct(product).colwise().sum();
    for (Index l = 0; l < width; ++l) {
      const double share = bend[l] > 0 ? rho[l] / bend[l] : 0;
      x.col(l) += share * p.col(l);
      rest.col(l) -= share * product.col(l);
    }
    if (i + 1 == kIterations) break;
    z = directed(rest);
    const Eigen::RowVectorXd next = rest.cwiseProduct(z).colwise().sum();
    for (Index l = 0; l < width; ++l)
      p.col(l) = z.col(l) + (rho[l] > 0 ? next[l] / rho[l] : 0) * p.col(l);
    rho = next;
  }
  std::vector<CloserLook> out;
  for (Index l = 0; l < width; ++l) {
    const NormalEquations& own = equations[static_cast<std::size_t>(l)];
    const VectorXd step = x.col(l);
    const VectorXd bent = right.col(l) - rest.col(l) - prior.cwiseProduct(step);  // normal * step
    out.push_back({step, own.misfit + step.dot(bent) + 2 * step.dot(own.gradient)});
  }
  return out;
}

}  // namespace framewatch::estimator
