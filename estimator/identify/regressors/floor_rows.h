// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "estimator/identify/elements/floor_layout.h"

namespace framewatch::estimator {

/// Share of the sensor noise in the normal matrix that the solver subtracts. To subtract all of it
/// would be unbiased, but the solution would diverge where there is little signal. The right-hand
/// side is corrected so that the remaining noise biases toward theta0 only. docs/equations.md,
/// noise in the regressors.
inline constexpr double kCompensatedShare = 0.8;

struct FloorRows;

/// Computes the part of a floor's sensor noise per instant that a solver subtracts, packed like the
/// sums: `share` of the normal matrix, and the part of the right-hand side that lets the rest bias
/// toward theta0.
void pack_compensation(const FloorLayout& layout, int floor, const FloorRows& rows, double share,
                       std::vector<double>& out);

/// Two poles of a filter. Its natural responses follow s[t] = -a1 s[t-1] - a2 s[t-2].
struct PolePair {
  double a1 = 0, a2 = 0;
};

/// The projected equations of one floor. Row r is sum_f phi_rf (equation f), filtered by its
/// oscillator section and scaled by the root of its weight.
struct FloorRows {
  /// Returns true if every size fits a floor of this layout. Sizes read from a file may have any
  /// value.
  bool fits(const FloorLayout& layout, int floor) const;

  int rows = 0;
  std::vector<double> gain, a1, a2;  ///< OscillatorSection of every row
  std::vector<double> frequency_hz;  ///< corner frequency of the section
  /// rows x padded(front): multiplies the filtered front signals [deformations..., response].
  std::vector<double> beta;
  std::vector<double> response;  ///< rows x frames: -phi_rf, which forms the response from m p''
  /// Energy that sensor noise adds per instant, for x = 1: to the normal matrix (unknowns x
  /// unknowns), to the right-hand side, and to the response.
  std::vector<double> noise_energy;
  std::vector<double> noise_diagonal;  ///< diagonal of noise_energy
  std::vector<double> noise_bias;      ///< noise_energy times PerturbedDesigns
  std::vector<double> noise_right;
  double noise_response = 0;
  /// The part of the noise that the solver subtracts per instant, packed like the sums.
  std::vector<double> noise_compensation;
  /// For groups: the unknown whose solution each unknown takes. Empty: every unknown has its own.
  std::vector<int> same_as;
  /// For groups: the relative standard error that each unknown gets from its share of a merged
  /// group.
  std::vector<double> share_error;
  double noise_residual = 0;  ///< expected weighted squared residual per instant

  void archive(auto& a) {
    a(rows);
    for (std::vector<double>* values :
         {&gain, &a1, &a2, &frequency_hz, &beta, &response, &noise_energy, &noise_diagonal,
          &noise_bias, &noise_right, &noise_compensation})
      a.any_size(*values);
    a.finite(noise_response, noise_residual);
  }
};

}  // namespace framewatch::estimator
