#include "estimator/identify/noise_share.h"

#include <algorithm>

namespace framewatch {
NoiseShare::NoiseShare(const FloorLayout& layout)
    : layout_(layout),
      floor_(static_cast<std::size_t>(layout.floors())),
      energy_(static_cast<std::size_t>(layout.unknowns()), 0.0) {}

void NoiseShare::update(const RowChain& rows, const WindowSums& sums, double level) {
  std::fill(energy_.begin(), energy_.end(), 0.0);
  residual_ = 0;
  level_ = level;
  for (int f = 0; f < layout_.floors(); ++f) {
    Floor& floor = floor_[static_cast<std::size_t>(f)];
    floor.rows = &rows.floor_rows(f);
    floor.instants = sums.floor_instants(f);
    residual_ += floor.instants * floor.rows->noise_residual;
    const int unknowns = layout_.front(f) - 1;
    for (int p = 0; p < unknowns; ++p)
      energy_[static_cast<std::size_t>(f * layout_.own() + p)] +=
          floor.instants * floor.rows->noise_energy[static_cast<std::size_t>(p * unknowns + p)];
  }
}

}  // namespace framewatch
