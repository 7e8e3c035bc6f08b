// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/spectra/row_gram.h"
#include "estimator/diagnose/spectra/whiteners.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {

/// A hidden resonator: the direction of its force and its transmissibility in every bin. It may be
/// in motion at the ends of a segment, like the building.
struct HiddenOscillator {
  Eigen::VectorXd direction;
  Eigen::VectorXcd transmissibility;
};

/// Returns the whitened rows of one bin, complex. rows: of all bins, in the order of Weights.
Eigen::VectorXcd rows_of_bin(const Eigen::Ref<const Eigen::VectorXd>& rows, Eigen::Index bin,
                             Eigen::Index equations);

/// Weights of the equations of one segment, docs/equations.md (33). Projects out the end terms
/// (32). Whitened rows are ordered bin by bin: the real parts of all equations, then the imaginary
/// parts.
class Weights {
 public:
  /// whitener: inverse of L of every bin, L L^H = N D S D^H. w: rad/s of the bins. read:
  /// ReadMotions::read if some motions are not read by any axis, otherwise empty.
  Weights(std::vector<Whitener> whitener, const Eigen::VectorXd& w,
          std::vector<HiddenOscillator> hidden, Eigen::MatrixXd read = {});

  Eigen::Index bins() const { return static_cast<Eigen::Index>(whitener_.size()); }
  Eigen::Index equations() const { return whitener_.front().equations(); }
  const Whitener& whitener(Eigen::Index bin) const {
    return whitener_[static_cast<std::size_t>(bin)];
  }

  /// Returns the forces on the equations whose whitened rows in a bin, complex, are `rows`.
  Eigen::VectorXcd forces_of(Eigen::Index bin, const Eigen::VectorXcd& rows) const;

  /// Returns the inverse of the equations' noise covariance in a bin: whitener^H whitener.
  Eigen::MatrixXcd metric(Eigen::Index bin) const { return whitener(bin).metric(); }

  /// Returns forces, equations x bins, as whitened rows.
  Eigen::VectorXd whitened(const Eigen::MatrixXcd& forces) const;
  /// Returns whitener^H rows: equations x bins.
  Eigen::MatrixXcd turned_back(const Eigen::VectorXd& rows) const;

  /// Returns the number of end terms. Their columns, each of unit length, are E: rows x ends().
  Eigen::Index ends() const { return scale_.size(); }
  /// E'E.
  const Eigen::MatrixXd& ends_square() const { return square_; }
  /// Returns left E of one bin. left: any number of rows x the bin's rows.
  RowMatrix times_ends(Eigen::Index bin, const RowMatrix& left) const;
  /// Returns rows - E (E'E)^-1 E' rows.
  Eigen::VectorXd without_ends(const Eigen::VectorXd& rows) const;

  /// Sets `out` to X, the whitened rows of one bin under unit forces on each of its n equations: n
  /// real forces, then n of value -j. transposed: X'. Padded with zeros to whole lanes.
  void put_unit_forces(Eigen::Index bin, bool transposed, RowMatrix& out) const;
  /// Adds F along to `sum`. F' holds the end terms of a bin as unit forces, so that E = X F'.
  /// along: X' times any matrix, 2 n rows.
  void add_shares(Eigen::Index bin, const RowMatrix& along, RowMatrix& sum) const;

 private:
  /// Returns true if a bin's whitener is triangular: all motions are read.
  bool is_triangular() const { return read_.size() == 0; }
  /// Returns F' size. size: of the unscaled terms.
  Eigen::VectorXd shared(Eigen::Index bin, const Eigen::VectorXd& size) const;

  std::vector<Whitener> whitener_;
  Eigen::VectorXd relative_;  ///< frequency of every bin over the band's middle
  std::vector<HiddenOscillator> hidden_;
  Eigen::MatrixXd read_;
  Eigen::VectorXd scale_;  ///< of the columns
  Eigen::MatrixXd square_;
  Ldlt factor_;
};

}  // namespace framewatch::estimator
