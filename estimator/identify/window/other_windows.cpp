#include "estimator/identify/window/other_windows.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {

OtherWindows::OtherWindows(const Structure& structure, const FloorLayout& layout,
                           const ParameterTable& table, const EstimatorOptions& options,
                           const std::vector<int>& blocks, int block_rows)
    : rate_hz_(options.rate_hz), current_(static_cast<int>(blocks.size())) {
  int steps = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    windows_.push_back({WindowSolution(structure, layout, table, options),
                        WindowEstimate(static_cast<std::size_t>(table.size()))});
    windows_.back().estimate.window = static_cast<int>(windows_.size());
    steps += windows_.back().solution.error_steps();
  }
  // One instant of each window's share goes to its solution.
  const int instants = std::max(1, block_rows - count() - 1);
  steps_per_instant_ = (steps + instants - 1) / instants;
}

void OtherWindows::restart() {
  for (Window& window : windows_) window.solution.restart();
  current_ = count();
}

void OtherWindows::hold(int unknown, double ratio, double std_error) {
  for (Window& window : windows_) window.solution.hold(unknown, ratio, std_error);
}

void OtherWindows::retuned() {
  for (Window& window : windows_) window.solution.retuned();
  current_ = count();
}

void OtherWindows::block_closed(const SlidingGram& sums, Time time) {
  end_ = time;
  current_ = -1;
  solved_ = false;
  next(sums);
}

void OtherWindows::next(const SlidingGram& sums) {
  do {
    ++current_;
  } while (current_ < count() && !sums.span_full(current_));
}

const WindowEstimate* OtherWindows::advance(const Context& c) {
  if (current_ >= count()) return nullptr;
  Window& window = windows_[static_cast<std::size_t>(current_)];
  if (!solved_) {
    const WindowParts sums = c.regression->sums().span(current_);
    rows_ = sums.rows;
    window.solution.solve(sums, c.regression->rows(), c.trust, true);
    window.solution.begin_errors(c.regression->sums(), *c.main);
    solved_ = true;
    return nullptr;
  }
  if (!window.solution.advance_errors(steps_per_instant_)) return nullptr;
  return give(c);
}

const WindowEstimate* OtherWindows::give(const Context& c) {
  Window& window = windows_[static_cast<std::size_t>(current_)];
  window.solution.fill({&c.regression->tuning().theta0(), c.known, c.tuned, c.main},
                       window.estimate);
  for (int p = 0; p < c.drift->elements(); ++p)
    window.estimate.amplitude[static_cast<std::size_t>(p)] =
        c.drift->rms(p, rows_ / c.drift->block_rows());
  window.estimate.rows = rows_;
  window.estimate.end = end_;
  window.estimate.start = end_ - SensorClock::duration(std::llround((rows_ - 1) * 1e6 / rate_hz_));
  ++window.estimate.sequence;
  solved_ = false;
  next(c.regression->sums());
  return &window.estimate;
}

}  // namespace framewatch::estimator
