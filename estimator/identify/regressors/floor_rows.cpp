// SPDX-License-Identifier: MIT
#include "estimator/identify/regressors/floor_rows.h"

#include <algorithm>
#include <cmath>

#include "estimator/identify/elements/guessed_design.h"
#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {

bool FloorRows::fits(const FloorLayout& layout, int floor) const {
  const auto is = [](const std::vector<double>& values, int size) {
    return values.size() == static_cast<std::size_t>(size) &&
           std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  };
  const int stride = padded(layout.front(floor));
  const int unknowns = layout.front(floor) - 1;
  int packed = 0;
  for (int i = 0; i <= unknowns; ++i) packed += stride - packed_row_begin(i);
  return rows >= 0 && rows <= layout.frames() && is(gain, rows) && is(a1, rows) && is(a2, rows) &&
         is(frequency_hz, rows) && is(beta, rows * stride) &&
         is(response, rows * layout.frames()) && is(noise_energy, unknowns * unknowns) &&
         is(noise_diagonal, unknowns) && is(noise_bias, unknowns * PerturbedDesigns::kCount) &&
         is(noise_right, unknowns) && is(noise_compensation, packed) &&
         std::isfinite(noise_response) && std::isfinite(noise_residual);
}

void pack_compensation(const FloorLayout& layout, int floor, const FloorRows& rows, double share,
                       std::vector<double>& out) {
  const int front = layout.front(floor);
  const int stride = padded(front);
  const int unknowns = front - 1;
  const auto energy = [&](int p, int q) {
    return rows.noise_energy[static_cast<std::size_t>(p * unknowns + q)];
  };
  double whole = 0;
  for (int p = 0; p < unknowns; ++p)
    for (int q = p; q < unknowns; ++q) whole += (q == p ? 1 : 2) * energy(p, q);
  const auto entry = [&](int i, int j) {  // i <= j
    if (j > unknowns) return 0.0;
    if (j < unknowns) return share * energy(i, j);
    if (i == unknowns) return rows.noise_response - (1 - share) * whole;
    double sum = rows.noise_right[static_cast<std::size_t>(i)];
    for (int q = 0; q < unknowns; ++q) sum -= (1 - share) * energy(i, q);
    return sum;
  };
  out.clear();
  for (int i = 0; i < front; ++i)
    for (int j = packed_row_begin(i); j < stride; ++j)
      out.push_back(entry(std::min(i, j), std::max(i, j)));
}

}  // namespace framewatch::estimator
