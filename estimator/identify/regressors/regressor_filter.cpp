#include "estimator/identify/regressors/regressor_filter.h"

#include <algorithm>

#include "estimator/numeric/kernels.h"

namespace framewatch::estimator {
namespace {

constexpr int kShapes = 4;  // of a row: two of the high-pass, two of its oscillator section

}  // namespace

RegressorFilter::RegressorFilter(RegressorTuning& tuning, const FloorLayout& layout, int settle)
    : RowFilter(layout), tuning_(&tuning), layout_(&layout), settle_(settle) {
  floor_.reserve(static_cast<std::size_t>(layout.floors()));
  for (int floor = 0; floor < layout.floors(); ++floor) {
    const int stride = padded(layout.front(floor));
    const auto size = static_cast<std::size_t>(layout.frames() * stride);
    floor_.push_back({nullptr, tuning.rows(floor), std::vector<double>(size),
                      std::vector<double>(size), UnknownPast(stride, layout.frames(), kShapes)});
  }
  signal_.assign(static_cast<std::size_t>(padded(layout.own() + 2 * layout.frames() + 1)), 0.0);
  response_.assign(static_cast<std::size_t>(layout.frames()), 0.0);
  changed_.reserve(static_cast<std::size_t>(layout.floors()));
  known_.resize(static_cast<std::size_t>((layout.floors() + 1) * layout.frames()));
  reset(settle);
}

void RegressorFilter::reset(int settle) {
  settle_ = settle;
  std::fill(known_.begin(), known_.end(), std::uint8_t{1});
  for (int floor = 0; floor < layout_->floors(); ++floor) rebuild(floor);
}

void RegressorFilter::rebuild(int floor) {
  Floor& f = floor_[static_cast<std::size_t>(floor)];
  if (all_known_around(floor)) {
    f.rows = &tuning_->rows(floor);
  } else {
    tuning_->rows(floor, known_, f.some_known);
    f.rows = &f.some_known;
  }
  std::fill(f.s1.begin(), f.s1.end(), 0.0);
  std::fill(f.s2.begin(), f.s2.end(), 0.0);
  f.settling = settle_ + 1;
  f.past.end();
  f.starting = tuning_->removes_past() && settle_ == 0;  // what settles owes nothing
  if (!f.starting) return;
  f.past.begin(f.rows->rows);
  for (int r = 0; r < f.rows->rows; ++r) {
    const auto row = static_cast<std::size_t>(r);
    f.past.add(r, tuning_->high_pass_poles());
    f.past.add(r, {f.rows->a1[row], f.rows->a2[row]});
  }
}

bool RegressorFilter::all_known_around(int floor) const {
  const auto first = known_.begin() + floor * layout_->frames();
  const int levels = layout_->next(floor) > 0 ? 3 : 2;
  return std::all_of(first, first + levels * layout_->frames(), [](auto k) { return k != 0; });
}

bool RegressorFilter::same_surroundings(int floor, const std::vector<std::uint8_t>& known) const {
  const auto first = known.begin() + floor * layout_->frames();
  const int levels = layout_->next(floor) > 0 ? 3 : 2;
  return std::equal(first, first + levels * layout_->frames(),
                    known_.begin() + floor * layout_->frames());
}

void RegressorFilter::push(const DeformationSet& set) {
  if (set.known != known_) {
    changed_.clear();
    for (int floor = 0; floor < layout_->floors(); ++floor)
      if (!same_surroundings(floor, set.known)) changed_.push_back(floor);
    known_ = set.known;
    for (const int floor : changed_) rebuild(floor);
  }
  const int own = layout_->own();
  const int frames = layout_->frames();
  const int motion_stride = own + frames;
  for (int floor = 0; floor < layout_->floors(); ++floor) {
    Floor& f = floor_[static_cast<std::size_t>(floor)];
    if (f.settling > 0) --f.settling;
    const int next = layout_->next(floor);
    const int stride = padded(layout_->front(floor));
    const double* here = &set.values[static_cast<std::size_t>(floor * motion_stride)];
    std::copy(here, here + own, signal_.begin());
    if (next > 0)
      std::copy(here + motion_stride, here + motion_stride + next, signal_.begin() + own);
    std::fill(signal_.begin() + own + next, signal_.begin() + stride, 0.0);
    for (int r = 0; r < f.rows->rows; ++r) {
      const double* weight = &f.rows->response[static_cast<std::size_t>(r * frames)];
      double response = 0;
      for (int g = 0; g < frames; ++g) response += weight[g] * here[own + g];
      response_[static_cast<std::size_t>(r)] = response;
    }
    kernels::in_use->filter_rows(signal_.data(), response_.data(), own + next, f.rows->gain.data(),
                                 f.rows->a1.data(), f.rows->a2.data(), f.s1.data(), f.s2.data(),
                                 f.rows->beta.data(), &rows_[offset(floor)], f.rows->rows, stride);
    f.starting = !f.past.remove(&rows_[offset(floor)]);
  }
}

/// Here, because the tuning must not need the filter that needs it.
std::unique_ptr<RowFilter> RegressorTuning::make_filter(int settle) {
  return std::make_unique<RegressorFilter>(*this, *layout_, settle);
}

}  // namespace framewatch::estimator
