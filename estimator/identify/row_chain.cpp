#include "estimator/identify/row_chain.h"

#include <algorithm>

#include "estimator/identify/kernels.h"

namespace framewatch {

RowChain::RowChain(const RowTuning& tuning, const FloorLayout& layout, int settle)
    : tuning_(&tuning), layout_(&layout), settle_(settle) {
  floor_.resize(static_cast<std::size_t>(layout.floors()));
  std::size_t at = 0;
  for (int floor = 0; floor < layout.floors(); ++floor) {
    offset_.push_back(at);
    at += static_cast<std::size_t>(layout.frames() * padded(layout.front(floor)));
  }
  rows_.assign(at, 0.0);
  signal_.assign(static_cast<std::size_t>(padded(layout.own() + 2 * layout.frames() + 1)), 0.0);
  reset();
}

void RowChain::reset() {
  known_.assign(static_cast<std::size_t>((layout_->floors() + 1) * layout_->frames()), 1);
  for (int floor = 0; floor < layout_->floors(); ++floor) rebuild(floor);
}

void RowChain::rebuild(int floor) {
  Floor& f = floor_[static_cast<std::size_t>(floor)];
  f.rows = tuning_->rows(floor, known_);
  const std::size_t states = static_cast<std::size_t>(f.rows.rows * padded(layout_->front(floor)));
  f.s1.assign(states, 0.0);
  f.s2.assign(states, 0.0);
  f.settling = settle_ + 1;
}

bool RowChain::same_surroundings(int floor, const std::vector<std::uint8_t>& known) const {
  const auto first = known.begin() + floor * layout_->frames();
  const int levels = layout_->next(floor) > 0 ? 3 : 2;
  return std::equal(first, first + levels * layout_->frames(),
                    known_.begin() + floor * layout_->frames());
}

void RowChain::push(const DeformationSet& set) {
  if (set.known != known_) {
    std::vector<int> changed;
    for (int floor = 0; floor < layout_->floors(); ++floor)
      if (!same_surroundings(floor, set.known)) changed.push_back(floor);
    known_ = set.known;
    for (const int floor : changed) rebuild(floor);
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
    double* out = &rows_[offset(floor)];
    for (int r = 0; r < f.rows.rows; ++r) {
      const auto row = static_cast<std::size_t>(r);
      double response = 0;
      for (int g = 0; g < frames; ++g)
        response +=
            f.rows.response[row * static_cast<std::size_t>(frames) + static_cast<std::size_t>(g)] *
            here[own + g];
      signal_[static_cast<std::size_t>(own + next)] = response;
      for (int j = own + next + 1; j < stride; ++j) signal_[static_cast<std::size_t>(j)] = 0;
      const std::size_t at = row * static_cast<std::size_t>(stride);
      kernels::in_use->filter_row(signal_.data(), f.rows.gain[row], f.rows.a1[row], f.rows.a2[row],
                                  &f.s1[at], &f.s2[at], &f.rows.beta[at], out + at, stride);
    }
  }
}

}  // namespace framewatch
