#pragma once

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/linearised.h"

namespace framewatch::estimator {

/// Inner products of the whitened columns of one bin, made from those of the few directions that
/// the columns have (Columns). Of a tall building that is a tenth of the work of the columns
/// themselves, and none of their memory.
class BinProducts {
 public:
  /// Of the unknowns `kept`, then the residual; of a large building without its end terms.
  BinProducts(const Linearised& at, std::size_t record, const std::vector<Eigen::Index>& kept);

  void compute(Eigen::Index bin);
  /// Of what compute() does only that which of_axis(), under_metric() and between() need.
  void put_metric(Eigen::Index bin);
  const Eigen::MatrixXcd& metric() const { return metric_; }
  /// Adds the products of the columns with each other, `weight` times, to the upper triangle of
  /// `sum`; its rows are padded, and what is left of the diagonal is anything.
  void add_square(RowMatrix& sum, double weight = 1);
  /// The columns under the metric, at the equations: real parts, then imaginary parts with opposite
  /// sign; 2 equations x columns, padded. As Weights::add_shares() takes them.
  const RowMatrix& at_equations() const { return at_equations_; }

  /// Where a direction of forces is not zero.
  struct Entry {
    Eigen::Index equation;
    double real, imaginary;
  };
  using Direction = std::vector<Entry>;
  static Direction of_force(const Eigen::VectorXd& force);
  /// Of an axis' reading, in this bin.
  const Direction& of_axis(Eigen::Index axis) const {
    return axes_[static_cast<std::size_t>(axis)];
  }
  /// direction^H metric: equations.
  Eigen::RowVectorXcd under_metric(const Direction& direction) const;
  /// a^H metric b.
  std::complex<double> between(const Direction& a, const Direction& b) const;
  /// Its product with every column: direction^H metric column.
  Eigen::RowVectorXcd with_columns(const Direction& direction) const;
  /// The same with the last column, the residual.
  std::complex<double> with_last(const Direction& direction) const;
  /// sum += real(conj(size) direction^H metric column) of every column.
  void add_columns(const Direction& direction, std::complex<double> size,
                   Eigen::Ref<Eigen::VectorXd> sum) const;
  /// rows^H column for every column; rows: whitened, of a bin that compute() need not have had.
  Eigen::RowVectorXcd with_rows(Eigen::Index bin, const Eigen::VectorXcd& rows);

 private:
  struct Complexes {
    RowMatrix real, imaginary;
  };

  void put_axes(Eigen::Index bin);
  void put_effects(Eigen::Index bin);
  /// One column without a direction, as whitened rows.
  void put_effect(Eigen::Index bin, Eigen::Index column, Eigen::Ref<Eigen::VectorXcd> out) const;
  /// The products of forces with every direction, from `under_`.
  void put_products();
  /// The products of elements and axes with the columns, from those of the equations.
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
