// SPDX-License-Identifier: MIT
#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/fit_columns.h"

namespace framewatch::estimator {

/// Inner products of the whitened columns of one bin. Computes them from the products of the few
/// directions that the columns have (Columns). For a tall building this takes a tenth of the work
/// and no memory for the columns.
class BinProducts {
 public:
  /// Columns: the unknowns `kept`, then the residual. For a large building the end terms are
  /// projected out of the residual.
  BinProducts(const Linearised& at, std::size_t record, const std::vector<Eigen::Index>& kept);

  void compute(Eigen::Index bin);
  /// Does only the part of compute() that of_axis(), under_metric() and between() need.
  void put_metric(Eigen::Index bin);
  const Eigen::MatrixXcd& metric() const { return metric_; }
  /// Adds the products of the columns, times `weight`, to the upper triangle of `sum`. The rows of
  /// `sum` are padded; its lower triangle is undefined.
  void add_square(RowMatrix& sum, double weight = 1);
  /// Returns the columns under the metric, at the equations: real parts, then negated imaginary
  /// parts; 2 equations x columns, padded, as in Weights::add_shares().
  const RowMatrix& at_equations() const { return at_equations_; }

  /// A nonzero entry of a direction of forces.
  struct Entry {
    Eigen::Index equation;
    double real, imaginary;
  };
  using Direction = std::vector<Entry>;
  static Direction of_force(const Eigen::VectorXd& force);
  /// Returns the direction of an axis' reading in this bin.
  const Direction& of_axis(Eigen::Index axis) const {
    return axes_[static_cast<std::size_t>(axis)];
  }
  /// Returns direction^H metric: one entry per equation.
  Eigen::RowVectorXcd under_metric(const Direction& direction) const;
  /// Returns a^H metric b.
  std::complex<double> between(const Direction& a, const Direction& b) const;
  /// Returns direction^H metric column for every column.
  Eigen::RowVectorXcd with_columns(const Direction& direction) const;
  /// Returns direction^H metric column for the last column, the residual.
  std::complex<double> with_last(const Direction& direction) const;
  /// Adds real(conj(size) direction^H metric column) of every column to `sum`.
  void add_columns(const Direction& direction, std::complex<double> size,
                   Eigen::Ref<Eigen::VectorXd> sum) const;
  /// Returns rows^H column for every column. rows: whitened rows of a bin, which need not be the
  /// one of compute().
  Eigen::RowVectorXcd with_rows(Eigen::Index bin, const Eigen::VectorXcd& rows);

 private:
  struct Complexes {
    RowMatrix real, imaginary;
  };

  void put_axes(Eigen::Index bin);
  void put_effects(Eigen::Index bin);
  /// Sets `out` to the whitened rows of one column without a direction.
  void put_effect(Eigen::Index bin, Eigen::Index column, Eigen::Ref<Eigen::VectorXcd> out) const;
  /// Computes the products of forces with every direction, from `under_`.
  void put_products();
  /// Computes the products of elements and axes with the columns, from those of the equations.
  void put_others();

  const Linearised& at_;
  const Whitened& system_;
  const Columns& columns_;
  const Eigen::VectorXd& last_;                    ///< the residual
  std::vector<Eigen::Index> kept_, direction_of_;  ///< of every column; -1: of an effect
  bool axes_too_ = false;                          ///< a column has the direction of an axis
  std::vector<Direction> elements_, axes_;
  Eigen::MatrixXcd metric_;
  Complexes under_;     ///< forces^H metric, of one equation
  Complexes products_;  ///< 1 x directions
  Complexes all_;       ///< directions (elements, axes, equations) x columns
  Eigen::VectorXd size_real_, size_imaginary_;
  std::vector<Eigen::Index> effects_;  ///< columns without a direction
  Eigen::MatrixXcd whitened_effects_, under_effects_;
  RowMatrix at_equations_;
};

}  // namespace framewatch::estimator
