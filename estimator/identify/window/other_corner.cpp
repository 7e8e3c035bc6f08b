#include "estimator/identify/window/other_corner.h"

#include <algorithm>
#include <utility>

#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {
namespace {

constexpr int kFloorsPerInstant = 4;  // tuned

}  // namespace

OtherCorner::OtherCorner(std::unique_ptr<RowTuning> tuning, const Structure& structure,
                         const FloorLayout& layout, const ParameterTable& table,
                         const EstimatorOptions& options, int rows)
    : tuning_(std::move(tuning)),
      rows_filter_(tuning_->make_filter(0)),
      shape_(layout),
      floors_(layout.floors()),
      rows_(rows),
      parts_per_instant_(layout.grouped() ? 1 : kFloorsPerInstant),
      solution_(structure, layout, table, options),
      sum_(shape_.size, 0.0),
      zero_(shape_.size, 0.0),
      instants_(static_cast<std::size_t>(floors_), 0) {}

void OtherCorner::restart(int settle) {
  rows_filter_->reset(settle);
  settling_ = settle + 1;
  solution_.restart();
  std::fill(sum_.begin(), sum_.end(), 0.0);
  std::fill(instants_.begin(), instants_.end(), 0);
  count_ = 0;
  resting_ = false;
}

void OtherCorner::retune(const RowTuning& active) {
  if (tuning_->axes() != active.axes()) tuning_->set_axes(active.axes(), active.ratios());
  tuning_->set_theta0(active.theta0(), active.noise_density());
  next_part_ = 0;
  resting_ = true;
}

bool OtherCorner::tune() {
  if (next_part_ >= tuning_->parts()) return false;
  for (int i = 0; i < parts_per_instant_ && next_part_ < tuning_->parts(); ++i)
    tuning_->tune(next_part_++);
  return true;
}

void OtherCorner::advance(const MotionRing& ring) {
  rows_filter_->push(ring.at(ring.end() - 1));
  if (settling_ > 0 && --settling_ > 0) return;
  if (full()) return;
  for (int f = 0; f < floors_; ++f) {
    const GramShape::Floor& shape = shape_.floor[static_cast<std::size_t>(f)];
    double* to = &sum_[shape.offset];
    kernels::in_use->add_rows(to, to, rows_filter_->rows(f), rows_filter_->count(f), shape.front,
                              shape.stride);
    if (rows_filter_->count(f) > 0) ++instants_[static_cast<std::size_t>(f)];
  }
  ++count_;
}

const WindowSolution& OtherCorner::solve(const WindowSolution::Trust& trust) {
  const WindowParts sums{&shape_, sum_.data(), zero_.data(), zero_.data(), rows_, &instants_};
  solution_.solve(sums, *rows_filter_, trust, true);
  return solution_;
}

}  // namespace framewatch::estimator
