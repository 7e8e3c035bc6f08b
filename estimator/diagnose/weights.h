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

  Eigen::Index ends() const { return scale_.size(); }
  /// Columns of the end terms at one bin: its rows x ends().
  void put_ends(Eigen::Index bin, Eigen::Ref<RowMatrix, 0, Eigen::OuterStride<>> out) const;
  /// rows - E (E'E)^-1 E' rows.
  Eigen::VectorXd without_ends(const Eigen::VectorXd& rows) const;

 private:
  std::vector<Eigen::MatrixXcd> whitener_;
  Eigen::VectorXd relative_;  ///< frequency of every bin over the band's middle
  std::vector<HiddenOscillator> hidden_;
  Eigen::VectorXd scale_;  ///< of the columns
  Eigen::LDLT<Eigen::MatrixXd> factor_;
};

}  // namespace framewatch
