#pragma once

#include <vector>

#include "estimator/identify/floor_layout.h"
#include "estimator/identify/row_chain.h"
#include "estimator/identify/window_sums.h"

namespace framewatch {

/// What sensor noise is expected to have put into the window's normal equations, and how much of it
/// the solver takes off. With W the noise in the matrix and w in the right-hand side, taking off
/// all of W would be unbiased but blows up where there is little but noise; so the share kTakenOff
/// of W goes, and the right-hand side is corrected such that the remaining pull is toward the
/// design only. docs/equations.md, noise in the regressors.
class NoiseShare {
 public:
  explicit NoiseShare(const FloorLayout& layout);

  /// level: variance of the noise over the configured one.
  void update(const RowChain& rows, const WindowSums& sums, double level);

  /// Takes the floor's part off a front (rows of `stride`, upper, response last).
  void take_off(int floor, double* front_rows, int stride) const;
  /// out += (1 - kTakenOff) W vector, internal order, over all floors: what is left in the matrix.
  void add_remaining(const std::vector<double>& vector, std::vector<double>& out) const;

  /// W's diagonal, internal order: energy each regressor has from noise.
  const std::vector<double>& energy() const { return energy_; }
  /// Expected weighted residual energy from noise alone.
  double residual() const { return residual_; }
  /// Response energy that take_off() removed in all floors together, so that residuals add up.
  bool takes_off() const { return level_ > 0; }

 private:
  struct Floor {
    const FloorRows* rows = nullptr;
    double instants = 0;
  };
  FloorLayout layout_;
  std::vector<Floor> floor_;
  std::vector<double> energy_;
  double residual_ = 0;
  double level_ = 0;
};

}  // namespace framewatch
