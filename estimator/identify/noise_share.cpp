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

void NoiseShare::add_remaining(const std::vector<double>& vector, std::vector<double>& out) const {
  for (int f = 0; f < layout_.floors(); ++f) {
    const Floor& floor = floor_[static_cast<std::size_t>(f)];
    if (floor.rows == nullptr) continue;
    const double left = floor.instants * (1 - (level_ > 0 ? kTakenOff : 0));
    const int unknowns = layout_.front(f) - 1;
    const auto base = static_cast<std::size_t>(f * layout_.own());
    for (int p = 0; p < unknowns; ++p) {
      for (int q = p; q < unknowns; ++q) {
        const double w =
            left * floor.rows->noise_energy[static_cast<std::size_t>(p * unknowns + q)];
        const auto i = base + static_cast<std::size_t>(p);
        const auto j = base + static_cast<std::size_t>(q);
        out[i] += w * vector[j];
        if (j != i) out[j] += w * vector[i];
      }
    }
  }
}

}  // namespace framewatch
