#pragma once

#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "estimator/diagnose/gram.h"

namespace framewatch {

/// A mass on a spring that does not end at rest either: where its force acts, and what it passes on
/// in every bin.
struct HiddenOscillator {
  Eigen::VectorXd direction;
  Eigen::VectorXcd passes;
};

/// What the equations of one stretch are weighed with, docs/equations.md (33), and the end terms
/// (32) that are projected out of them. Whitened rows: real parts, then imaginary parts of every
/// equation, bin by bin.
class Weights {
 public:
  /// whitener: inverse of L of every bin, L L^H = N D S D^H. w: rad/s of the bins.
  Weights(std::vector<Eigen::MatrixXcd> whitener, const Eigen::VectorXd& w,
          std::vector<HiddenOscillator> hidden);

  Eigen::Index bins() const { return static_cast<Eigen::Index>(whitener_.size()); }
  Eigen::Index equations() const { return whitener_.front().rows(); }
  const Eigen::MatrixXcd& whitener(Eigen::Index bin) const {
    return whitener_[static_cast<std::size_t>(bin)];
  }

  /// How many end terms. E: their columns, rows x ends(), each of length one.
  Eigen::Index ends() const { return scale_.size(); }
  /// E'E.
  const Eigen::MatrixXd& ends_square() const { return square_; }
  /// left E of one bin; left: any x the bin's rows.
  RowMatrix times_ends(Eigen::Index bin, const RowMatrix& left) const;
  /// rows - E (E'E)^-1 E' rows.
  Eigen::VectorXd without_ends(const Eigen::VectorXd& rows) const;

  /// What forces of unit size do to the rows of one bin, X: n of them, then n of size -j. n: the
  /// equations. transposed: of X'; padded with zeros to whole lanes.
  void put_unit_forces(Eigen::Index bin, bool transposed, RowMatrix& out) const;
  /// sum += F along, E being X F' in a bin. along: the 2 n rows of X' times anything.
  void add_shares(Eigen::Index bin, const RowMatrix& along, RowMatrix& sum) const;

 private:
  /// F' size, sizes of the unscaled terms.
  Eigen::VectorXd shared(Eigen::Index bin, const Eigen::VectorXd& size) const;

  std::vector<Eigen::MatrixXcd> whitener_;
  Eigen::VectorXd relative_;  ///< frequency of every bin over the band's middle
  std::vector<HiddenOscillator> hidden_;
  Eigen::VectorXd scale_;  ///< of the columns
  Eigen::MatrixXd square_;
  Eigen::LDLT<Eigen::MatrixXd> factor_;
};

/// E' rows, summed over bins.
class AlongEnds {
 public:
  explicit AlongEnds(const Weights& weights) : weights_(weights) {}

  /// rows of one bin, always of as many columns, a multiple of kLane.
  void add(Eigen::Index bin, const RowMatrix& rows);
  /// ends x columns.
  const RowMatrix& sum() const { return sum_; }

 private:
  const Weights& weights_;
  RowMatrix forces_, along_, sum_;
};

}  // namespace framewatch
