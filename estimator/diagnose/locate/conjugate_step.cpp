// SPDX-License-Identifier: MIT
#include "estimator/diagnose/locate/conjugate_step.h"

#include "estimator/diagnose/locate/candidate_places.h"
#include "estimator/diagnose/spectra/row_gram.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/kernels.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

constexpr int kIterations = 4;

/// Returns the curvature times x, one column per list, with the signals of its places free.
MatrixXd curvature_times(const Linearised& at, const std::vector<Index>& kept,
                         const std::vector<std::vector<CandidatePlace>>& lists, const MatrixXd& x) {
  const RowMatrix steps = x;
  RowMatrix sum = RowMatrix::Zero(x.rows(), x.cols());
  for (std::size_t r = 0; r < at.systems.size(); ++r) {
    BinCurvature curvature(at, r, kept, lists);
    for (Index b = 0; b < at.systems[r].bins(); ++b) curvature.add_times(b, steps, sum);
  }
  return sum;
}

}  // namespace

BinCurvature::BinCurvature(const Linearised& at, std::size_t record, const std::vector<Index>& kept,
                           const std::vector<std::vector<CandidatePlace>>& lists)
    : system_(at.systems[record]),
      columns_(at.columns[record]),
      kept_(kept),
      lists_(lists),
      products_(at, record, kept),
      axes_(at.plant->axis_count()) {
  const Plant& plant = *at.plant;
  for (Index e = 0; e < plant.element_count(); ++e)
    elements_.push_back(BinProducts::of_force(plant.building.act.col(e)));
  const Index n = plant.equations(), width = static_cast<Index>(lists.size());
  for (RowMatrix* m : {&along_.real, &along_.imaginary})
    m->setZero(plant.element_count() + axes_ + n, width);
  for (Complexes* c : {&forces_, &under_})
    for (RowMatrix* m : {&c->real, &c->imaginary}) m->setZero(n, width);
}

VectorXcd BinCurvature::effect_force(Index bin, Index unknown) const {
  const Index n = system_.operation.equations();
  const auto rows = columns_.effects.col(columns_.row[static_cast<std::size_t>(unknown)]);
  return system_.weights->forces_of(bin, rows_of_bin(rows, bin, n));
}

void BinCurvature::put_forces(Index bin, const RowMatrix& steps) {
  const Index n = forces_.real.rows(), first = along_.real.rows() - n;
  for (RowMatrix* m : {&along_.real, &along_.imaginary, &forces_.real, &forces_.imaginary})
    m->setZero();
  for (Index i = 0; i < steps.rows(); ++i) {
    const Index u = kept_[static_cast<std::size_t>(i)];
    const Index d = columns_.direction[static_cast<std::size_t>(u)];
    if (d >= 0) {
      const Complex size = columns_.size(bin, u);
      along_.real.row(d) += size.real() * steps.row(i);
      along_.imaginary.row(d) += size.imag() * steps.row(i);
    } else {
      const VectorXcd force = effect_force(bin, u);
      forces_.real.noalias() += force.real() * steps.row(i);
      forces_.imaginary.noalias() += force.imag() * steps.row(i);
    }
  }
  forces_.real += along_.real.bottomRows(n);
  forces_.imaginary += along_.imaginary.bottomRows(n);
  for (Index d = 0; d < first; ++d) {
    const Index axis = d - static_cast<Index>(elements_.size());
    const auto x = along_.real.row(d), y = along_.imaginary.row(d);
    for (const BinProducts::Entry& e :
         axis < 0 ? elements_[static_cast<std::size_t>(d)] : products_.of_axis(axis)) {
      forces_.real.row(e.equation) += e.real * x;
      forces_.imaginary.row(e.equation) += e.real * y;
      if (e.imaginary == 0) continue;
      forces_.real.row(e.equation) -= e.imaginary * y;
      forces_.imaginary.row(e.equation) += e.imaginary * x;
    }
  }
}

void BinCurvature::put_under_metric() {
  const Index n = forces_.real.rows(), width = forces_.real.cols();
  RowMatrix metric(2 * n, n), forces = RowMatrix::Zero(n, padded(static_cast<int>(2 * width))), out;
  // The metric is Hermitian, and its columns are contiguous in memory.
  for (Index i = 0; i < n; ++i) {
    metric.row(i) = products_.metric().col(i).real().transpose();
    metric.row(n + i) = -products_.metric().col(i).imag().transpose();
  }
  forces.leftCols(width) = forces_.real;
  forces.middleCols(width, width) = forces_.imaginary;
  multiply(metric, forces, out);
  under_.real = out.topLeftCorner(n, width) - out.block(n, width, n, width);
  under_.imaginary = out.block(0, width, n, width) + out.bottomLeftCorner(n, width);
  for (Index l = 0; l < width; ++l) {
    VectorXcd force(n), taken = VectorXcd::Zero(n);
    force.real() = forces_.real.col(l);
    force.imag() = forces_.imaginary.col(l);
    const MatrixXcd places = place_equations(products_, lists_[static_cast<std::size_t>(l)]);
    for (Index d = 0; d < places.rows(); ++d)
      taken += places.row(d).adjoint() * (places.row(d) * force)(0);
    under_.real.col(l) -= taken.real();
    under_.imaginary.col(l) -= taken.imag();
  }
}

void BinCurvature::put_along() {
  const Index n = under_.real.rows(), first = along_.real.rows() - n;
  for (Index d = 0; d < first; ++d) {
    const Index axis = d - static_cast<Index>(elements_.size());
    auto real = along_.real.row(d), imaginary = along_.imaginary.row(d);
    real.setZero();
    imaginary.setZero();
    for (const BinProducts::Entry& e :
         axis < 0 ? elements_[static_cast<std::size_t>(d)] : products_.of_axis(axis)) {
      const auto x = under_.real.row(e.equation), y = under_.imaginary.row(e.equation);
      real += e.real * x;
      imaginary += e.real * y;
      if (e.imaginary == 0) continue;
      real += e.imaginary * y;
      imaginary -= e.imaginary * x;
    }
  }
  along_.real.bottomRows(n) = under_.real;
  along_.imaginary.bottomRows(n) = under_.imaginary;
}

void BinCurvature::add_times(Index bin, const RowMatrix& steps, RowMatrix& sum) {
  products_.put_metric(bin);
  put_forces(bin, steps);
  put_under_metric();
  put_along();
  for (Index i = 0; i < steps.rows(); ++i) {
    const Index u = kept_[static_cast<std::size_t>(i)];
    const Index d = columns_.direction[static_cast<std::size_t>(u)];
    if (d >= 0) {
      const Complex size = columns_.size(bin, u);
      sum.row(i) += size.real() * along_.real.row(d) + size.imag() * along_.imaginary.row(d);
    } else {
      const VectorXcd force = effect_force(bin, u);
      sum.row(i) +=
          force.real().transpose() * under_.real + force.imag().transpose() * under_.imaginary;
    }
  }
}

std::vector<ConjugateStep> conjugate_steps(const Linearised& at, const std::vector<Index>& kept,
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
  std::vector<ConjugateStep> out;
  for (Index l = 0; l < width; ++l) {
    const NormalEquations& own = equations[static_cast<std::size_t>(l)];
    const VectorXd step = x.col(l);
    const VectorXd bent = right.col(l) - rest.col(l) - prior.cwiseProduct(step);  // normal * step
    out.push_back({step, own.misfit + step.dot(bent) + 2 * step.dot(own.gradient)});
  }
  return out;
}

}  // namespace framewatch::estimator
