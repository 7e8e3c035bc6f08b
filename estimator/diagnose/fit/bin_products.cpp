// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/bin_products.h"

#include <algorithm>

#include "estimator/numeric/complex.h"
#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::RowVectorXcd;

BinProducts::BinProducts(const Linearised& at, std::size_t record, const std::vector<Index>& kept)
    : at_(at),
      system_(at.systems[record]),
      columns_(at.columns[record]),
      last_(at.plant->is_large() ? system_.rest : system_.residual),
      kept_(kept) {
  const Plant& plant = *at.plant;
  const Index n = plant.equations(), own = static_cast<Index>(kept.size()) + 1;
  for (const Index u : kept)
    direction_of_.push_back(columns_.direction[static_cast<std::size_t>(u)]);
  direction_of_.push_back(-1);
  axes_too_ = std::any_of(direction_of_.begin(), direction_of_.end(), [&](Index d) {
    return d >= plant.element_count() && d < plant.element_count() + plant.axis_count();
  });
  for (Index c = 0; c < own; ++c)
    if (direction_of_[static_cast<std::size_t>(c)] < 0) effects_.push_back(c);
  for (Index e = 0; e < plant.element_count(); ++e)
    elements_.push_back(of_force(plant.building.act.col(e)));
  axes_.resize(static_cast<std::size_t>(plant.axis_count()));
  const Index directions = plant.element_count() + plant.axis_count() + n;
  const Index width = padded(static_cast<int>(own));
  for (RowMatrix* m : {&under_.real, &under_.imaginary}) m->setZero(1, n);
  for (RowMatrix* m : {&products_.real, &products_.imaginary}) m->setZero(1, directions);
  for (RowMatrix* m : {&all_.real, &all_.imaginary}) m->setZero(directions, width);
  at_equations_ = RowMatrix::Zero(2 * n, width);
  size_real_ = size_imaginary_ = Eigen::VectorXd::Zero(own);
  whitened_effects_.resize(n, static_cast<Index>(effects_.size()));
}

void BinProducts::put_axes(Index bin) {
  const Eigen::MatrixXcd operation = system_.operation[static_cast<std::size_t>(bin)];
  for (Index a = 0; a < at_.plant->axis_count(); ++a) {
    Direction& axis = axes_[static_cast<std::size_t>(a)];
    axis.clear();
    for (Index i = 0; i < operation.rows(); ++i)
      if (operation(i, a) != Complex(0, 0))
        axis.push_back({i, operation(i, a).real(), operation(i, a).imag()});
  }
}

void BinProducts::put_effect(Index bin, Index column, Eigen::Ref<Eigen::VectorXcd> out) const {
  const Index n = out.size();
  const auto c = static_cast<std::size_t>(column);
  const double* rows =
      c == kept_.size()
          ? last_.data()
          : columns_.effects.col(columns_.row[static_cast<std::size_t>(kept_[c])]).data();
  for (Index i = 0; i < n; ++i) out[i] = {rows[2 * n * bin + i], rows[2 * n * bin + n + i]};
}

void BinProducts::put_effects(Index bin) {
  for (std::size_t i = 0; i < effects_.size(); ++i)
    put_effect(bin, effects_[i], whitened_effects_.col(static_cast<Index>(i)));
  const Whitener& whitener = system_.weights->whitener(bin);
  under_effects_.resizeLike(whitened_effects_);
  for (Index i = 0; i < whitened_effects_.cols(); ++i)
    under_effects_.col(i) = whitener.adjoint_times(whitened_effects_.col(i));
}

void BinProducts::put_products() {
  const Index n = under_.real.cols();
  const double *x = under_.real.data(), *y = under_.imaginary.data();
  double *real = products_.real.data(), *imaginary = products_.imaginary.data();
  for (const Direction& element : elements_) {
    double r = 0, i = 0;
    for (const Entry& e : element) {
      r += x[e.equation] * e.real;
      i += y[e.equation] * e.real;
    }
    *real++ = r;
    *imaginary++ = i;
  }
  for (const Direction& axis : axes_) {
    double r = 0, i = 0;
    for (const Entry& e : axis) {
      r += x[e.equation] * e.real - y[e.equation] * e.imaginary;
      i += x[e.equation] * e.imaginary + y[e.equation] * e.real;
    }
    *real++ = r;
    *imaginary++ = i;
  }
  std::copy(x, x + n, real);
  std::copy(y, y + n, imaginary);
}

void BinProducts::put_metric(Index bin) {
  metric_ = system_.weights->metric(bin);
  put_axes(bin);
}

void BinProducts::compute(Index bin) {
  put_metric(bin);
  put_effects(bin);
  for (std::size_t c = 0; c < kept_.size(); ++c) {
    const Complex size = columns_.size(bin, kept_[c]);
    size_real_[static_cast<Index>(c)] = size.real();
    size_imaginary_[static_cast<Index>(c)] = size.imag();
  }
  const Index n = metric_.rows(), own = size_real_.size(), first = all_.real.rows() - n;
  const double *sr = size_real_.data(), *si = size_imaginary_.data();
  for (Index i = 0; i < n; ++i) {
    // The metric is Hermitian, and its columns are contiguous in memory.
    under_.real.row(0) = metric_.col(i).real();
    under_.imaginary.row(0) = -metric_.col(i).imag();
    put_products();
    const double *x = products_.real.data(), *y = products_.imaginary.data();
    double *real = &all_.real(first + i, 0), *imaginary = &all_.imaginary(first + i, 0);
    for (Index c = 0; c < own; ++c) {
      const Index d = direction_of_[static_cast<std::size_t>(c)];
      if (d < 0) continue;
      real[c] = x[d] * sr[c] - y[d] * si[c];
      imaginary[c] = x[d] * si[c] + y[d] * sr[c];
    }
    for (std::size_t k = 0; k < effects_.size(); ++k) {
      real[effects_[k]] = under_effects_(i, static_cast<Index>(k)).real();
      imaginary[effects_[k]] = under_effects_(i, static_cast<Index>(k)).imag();
    }
  }
  at_equations_.topRows(n) = all_.real.bottomRows(n);
  at_equations_.bottomRows(n) = -all_.imaginary.bottomRows(n);
}

void BinProducts::put_others() {
  const Index first = all_.real.rows() - metric_.rows();
  const int width = static_cast<int>(all_.real.cols());
  Index k = 0;
  for (const std::vector<Direction>* list : {&elements_, &axes_}) {
    if (list == &axes_ && !axes_too_) break;
    for (const Direction& one : *list) {
      all_.real.row(k).setZero();
      all_.imaginary.row(k).setZero();
      for (const Entry& e : one) {
        const double *x = &all_.real(first + e.equation, 0),
                     *y = &all_.imaginary(first + e.equation, 0);
        kernels::in_use->add_two(e.real, x, e.imaginary, y, &all_.real(k, 0), width);
        kernels::in_use->add_two(e.real, y, -e.imaginary, x, &all_.imaginary(k, 0), width);
      }
      ++k;
    }
  }
}

void BinProducts::add_square(RowMatrix& sum, double weight) {
  put_others();
  const Index own = size_real_.size();
  for (Index u = 0; u < own; ++u) {
    const Index k = direction_of_[static_cast<std::size_t>(u)];
    if (k < 0) continue;
    const int from = packed_row_begin(static_cast<int>(u));
    kernels::in_use->add_two(weight * size_real_[u], &all_.real(k, from),
                             weight * size_imaginary_[u], &all_.imaginary(k, from), &sum(u, from),
                             static_cast<int>(sum.cols()) - from);
    for (const Index v : effects_)
      if (v < u)
        sum(v, u) +=
            weight * (size_real_[u] * all_.real(k, v) + size_imaginary_[u] * all_.imaginary(k, v));
  }
  for (std::size_t i = 0; i < effects_.size(); ++i)
    for (std::size_t j = i; j < effects_.size(); ++j)
      sum(effects_[i], effects_[j]) +=
          weight * whitened_effects_.col(static_cast<Index>(i))
                       .dot(whitened_effects_.col(static_cast<Index>(j)))
                       .real();
}

Complex BinProducts::with_last(const Direction& direction) const {
  const Index first = all_.real.rows() - metric_.rows(), last = size_real_.size() - 1;
  Complex out = 0;
  for (const Entry& e : direction)
    out += Complex(e.real, -e.imaginary) *
           Complex(all_.real(first + e.equation, last), all_.imaginary(first + e.equation, last));
  return out;
}

void BinProducts::add_columns(const Direction& direction, Complex size,
                              Eigen::Ref<Eigen::VectorXd> sum) const {
  const Index first = all_.real.rows() - metric_.rows(), own = size_real_.size();
  for (const Entry& e : direction) {
    const Complex factor = Complex(e.real, e.imaginary) * size;
    sum += factor.real() * all_.real.row(first + e.equation).head(own).transpose();
    sum += factor.imag() * all_.imaginary.row(first + e.equation).head(own).transpose();
  }
}

RowVectorXcd BinProducts::with_rows(Index bin, const Eigen::VectorXcd& rows) {
  const Index n = rows.size();
  if (axes_too_) put_axes(bin);
  const Eigen::VectorXcd forces = system_.weights->whitener(bin).adjoint_times(rows);
  under_.real.row(0) = forces.real();
  under_.imaginary.row(0) = -forces.imag();
  put_products();
  RowVectorXcd out(size_real_.size());
  for (Index c = 0; c < out.size(); ++c) {
    const auto at = static_cast<std::size_t>(c);
    if (const Index d = direction_of_[at]; d >= 0)
      out[c] =
          Complex(products_.real(0, d), products_.imaginary(0, d)) * columns_.size(bin, kept_[at]);
  }
  Eigen::VectorXcd column(n);
  for (const Index c : effects_) {
    put_effect(bin, c, column);
    out[c] = rows.dot(column);
  }
  return out;
}

BinProducts::Direction BinProducts::of_force(const Eigen::VectorXd& force) {
  Direction out;
  for (Index i = 0; i < force.size(); ++i)
    if (force[i] != 0) out.push_back({i, force[i], 0});
  return out;
}

RowVectorXcd BinProducts::under_metric(const Direction& direction) const {
  RowVectorXcd out = RowVectorXcd::Zero(metric_.cols());
  for (const Entry& e : direction)
    out += Complex(e.real, -e.imaginary) * metric_.col(e.equation).adjoint();
  return out;
}

Complex BinProducts::between(const Direction& a, const Direction& b) const {
  Complex out = 0;
  for (const Entry& e : a)
    for (const Entry& f : b)
      out += Complex(e.real, -e.imaginary) * metric_(e.equation, f.equation) *
             Complex(f.real, f.imaginary);
  return out;
}

RowVectorXcd BinProducts::with_columns(const Direction& direction) const {
  const Index first = all_.real.rows() - metric_.rows(), own = size_real_.size();
  RowVectorXcd out = RowVectorXcd::Zero(own);
  for (const Entry& e : direction) {
    const auto x = all_.real.row(first + e.equation).leftCols(own);
    const auto y = all_.imaginary.row(first + e.equation).leftCols(own);
    out.real() += e.real * x + e.imaginary * y;
    out.imag() += e.real * y - e.imaginary * x;
  }
  return out;
}

}  // namespace framewatch::estimator
