#include "estimator/diagnose/locate/bin_curvature.h"

#include "estimator/diagnose/locate/place_products.h"
#include "estimator/diagnose/spectra/row_gram.h"
#include "estimator/numeric/complex.h"
#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;

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

}  // namespace framewatch::estimator
