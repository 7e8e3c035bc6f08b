#include "estimator/identify/solve/noise_compensation.h"

#include <algorithm>

namespace framewatch::estimator {
NoiseCompensation::NoiseCompensation(const FloorLayout& layout, double share)
    : layout_(layout),
      share_(share),
      floor_(static_cast<std::size_t>(layout.floors())),
      energy_(static_cast<std::size_t>(layout.unknowns()), 0.0) {
  if (share == kCompensatedShare) return;
  const GramShape shape(layout);
  for (std::size_t f = 0; f < floor_.size(); ++f) {
    const std::size_t end = f + 1 < floor_.size() ? shape.floor[f + 1].offset : shape.size;
    floor_[f].packed.assign(end - shape.floor[f].offset, 0.0);
  }
}

void NoiseCompensation::update(const RowFilter& rows, const WindowParts& sums, double level) {
  std::fill(energy_.begin(), energy_.end(), 0.0);
  residual_ = 0;
  level_ = level;
  for (int f = 0; f < layout_.floors(); ++f) {
    Floor& floor = floor_[static_cast<std::size_t>(f)];
    floor.rows = &rows.floor_rows(f);
    floor.instants = (*sums.instants)[static_cast<std::size_t>(f)];
    if (share_ != kCompensatedShare)
      pack_compensation(layout_, f, *floor.rows, share_, floor.packed);
    residual_ += floor.instants * floor.rows->noise_residual;
    const std::vector<double>& diagonal = floor.rows->noise_diagonal;
    double* energy = &energy_[static_cast<std::size_t>(f * layout_.own())];
    for (std::size_t p = 0; p < diagonal.size(); ++p) energy[p] += floor.instants * diagonal[p];
  }
}

}  // namespace framewatch::estimator
