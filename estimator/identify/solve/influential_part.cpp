// SPDX-License-Identifier: MIT
#include "estimator/identify/solve/influential_part.h"

#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {

InfluentialPart::InfluentialPart(const FloorLayout& layout, int most_blocks, double compensation)
    : layout_(layout),
      solver_(layout),
      noise_(layout, compensation),
      sum_(GramShape(layout).size, 0.0),
      zero_(sum_.size(), 0.0),
      kept_(static_cast<std::size_t>(layout.floors()), 0.0),
      instants_(kept_.size(), 0),
      next_step_(steps()) {
  block_.reserve(static_cast<std::size_t>(most_blocks));
  for (std::vector<double>* v :
       {&prior_, &centre_, &solution_, &information_, &total_, &move_, &noise_of_move_})
    v->assign(static_cast<std::size_t>(layout.unknowns()), 0.0);
}

/// Returns the first of the `part` consecutive blocks that have the largest share of the
/// information about an unknown.
int InfluentialPart::most_influential(const GramShape& shape, int part) {
  const int blocks = static_cast<int>(block_.size());
  int best = 0;
  double largest = 0;
  const auto information = [&](int block, std::size_t at) {
    const double* sums = block_[static_cast<std::size_t>(block)];
    return sums == nullptr ? 0 : sums[at];
  };
  for (const GramShape::Floor& floor : shape.floor) {
    std::size_t at = floor.offset;  // of the diagonal entry
    for (int i = 0; i < layout_.own(); ++i) {
      const std::size_t diagonal = at + static_cast<std::size_t>(i - packed_row_begin(i));
      at += static_cast<std::size_t>(floor.stride - packed_row_begin(i));
      double all = 0, run = 0;
      for (int b = 0; b < blocks; ++b) all += information(b, diagonal);
      for (int b = 0; b < blocks; ++b) {
        run += information(b, diagonal);
        if (b >= part) run -= information(b - part, diagonal);
        if (b + 1 >= part && run > largest * all) {
          largest = run / all;
          best = b + 1 - part;
        }
      }
    }
  }
  return best;
}

void InfluentialPart::begin(const GramShape& shape, const StorySolver& solver,
                            const std::vector<double>& prior, const std::vector<double>& centre,
                            const NoiseCompensation& noise) {
  shape_ = &shape;
  solution_ = solver.solution();
  information_ = solver.information();
  prior_ = prior;
  centre_ = centre;
  noise_ = noise;
  next_step_ = 0;
}

void InfluentialPart::advance(int count) {
  for (; count > 0 && running(); --count, ++next_step_) {
    if (next_step_ < layout_.floors())
      add_blocks(next_step_);
    else
      solve();
  }
}

void InfluentialPart::add_blocks(int floor) {
  const GramShape::Floor& shape = shape_->floor[static_cast<std::size_t>(floor)];
  const std::size_t end = floor + 1 < layout_.floors()
                              ? shape_->floor[static_cast<std::size_t>(floor) + 1].offset
                              : shape_->size;
  const auto size = static_cast<long>(end - shape.offset);
  double* sum = &sum_[shape.offset];
  std::fill(sum, sum + size, 0.0);
  for (const double* block : block_)
    if (block != nullptr) kernels::in_use->add(sum, block + shape.offset, size);
}

void InfluentialPart::solve() {
  for (int f = 0; f < layout_.floors(); ++f) noise_.keep(f, kept_[static_cast<std::size_t>(f)]);
  const WindowParts sums{shape_, sum_.data(), zero_.data(), zero_.data(), 0, &instants_};
  solver_.factor(sums, prior_, centre_, noise_);
  for (std::size_t u = 0; u < move_.size(); ++u) {
    const double rest = solver_.information()[u];
    const double move = std::abs(solver_.solution()[u] - solution_[u]);
    const bool known = solver_.usable(static_cast<int>(u)) && rest > 0 && std::isfinite(move);
    move_[u] = known ? move : 0;
    noise_of_move_[u] = known ? std::sqrt(std::max(information_[u] / rest - 1, 0.0)) : 0;
  }
}

}  // namespace framewatch::estimator
