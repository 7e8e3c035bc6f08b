// SPDX-License-Identifier: MIT
#include "estimator/identify/window/window_series.h"

#include <algorithm>

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
  // In each window's share, one instant goes to its solution.
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
    window.solution.begin_errors(c.regression->sums(), rows_ / c.regression->sums().block_rows(),
                                 *c.main);
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
  window.estimate.start = end_ - duration_of(rows_ - 1, rate_hz_);
  ++window.estimate.sequence;
  solved_ = false;
  next(c.regression->sums());
  return &window.estimate;
}

WindowSeries::WindowSeries(const Structure& structure, const FloorLayout& layout,
                           const ParameterTable& table, const EstimatorOptions& options,
                           double warm, const std::vector<int>& other_blocks, int block_rows)
    : main_(structure, layout, table, options, kCompensatedShare, warm),
      others_(structure, layout, table, options, other_blocks, block_rows),
      steps_per_instant_((main_.error_steps() + block_rows - 2) / (block_rows - 1)) {}

void WindowSeries::restart() {
  main_.restart();
  others_.restart();
}

void WindowSeries::retuned() {
  main_.retuned();
  others_.retuned();
}

void WindowSeries::hold(int unknown, double ratio, double std_error) {
  main_.hold(unknown, ratio, std_error);
  others_.hold(unknown, ratio, std_error);
}

WindowSeries::Done WindowSeries::advance(TunedRegression& regression, const Instant& now) {
  const std::int64_t instant = regression.next();
  const std::vector<std::uint8_t>& known = now.ring->at(instant).known;
  regression.advance(*now.ring);
  if (regression.suffices() && (now.due || regression.closes_block()))
    main_.solve(regression.sums().window(), regression.rows(), now.trust,
                regression.closes_block());
  Done done;
  done.block = regression.finish(*now.ring);
  done.closed = done.block && regression.suffices();
  if (done.closed) {
    main_.begin_errors(regression.sums(), regression.sums().blocks(), main_);
    others_.block_closed(regression.sums(), now.window_end);
    return done;
  }
  done.errors_new = main_.advance_errors(steps_per_instant_);
  done.other = others_.advance({&regression, &main_, &known, now.trust, now.tuned, now.drift});
  return done;
}

LateWindows::LateWindows(const PipelineConfig& config, const ParameterTable& table,
                         const FloorLayout& layout, double warm,
                         const std::vector<int>& other_blocks, int block_rows, int most_blocks,
                         int hop_rows)
    : rate_hz_(config.options.rate_hz),
      hop_rows_(hop_rows),
      blocks_(BatchMeans::kBlocks),
      series_(config.structure, layout, table, config.options, warm, other_blocks, block_rows),
      drift_(config, table, layout, block_rows, most_blocks),
      estimate_(static_cast<std::size_t>(table.size())) {
  estimate_.late = true;
  series_.mark_late();
}

void LateWindows::begin(TunedRegression& regression, std::int64_t from, std::int64_t until) {
  regression.start(from);
  series_.restart();
  drift_.restart();
  until_ = until;
  since_hop_ = 0;
  running_ = from < until;
}

void LateWindows::end() {
  running_ = false;
  series_.restart();
}

LateWindows::Given LateWindows::advance(TunedRegression& regression, const MotionRing& ring,
                                        const WindowSolution::Trust& trust, Time window_end) {
  const DeformationSet& set = ring.at(regression.next());
  drift_.push(set);
  const bool due = ++since_hop_ >= hop_rows_;
  if (due) since_hop_ = 0;
  Given given;
  given.other = series_.advance(regression, {&ring, trust, true, due, &drift_, window_end}).other;
  if (!due || !regression.suffices()) return given;
  estimate_.end = window_end;
  estimate_.rows = regression.sums().rows();
  estimate_.start = window_end - duration_of(estimate_.rows - 1, rate_hz_);
  ++estimate_.sequence;
  series_.main().fill({&regression.tuning().theta0(), &set.known, true}, estimate_);
  for (int p = 0; p < drift_.elements(); ++p)
    estimate_.amplitude[static_cast<std::size_t>(p)] = drift_.rms(p, blocks_);
  given.main = &estimate_;
  return given;
}

}  // namespace framewatch::estimator
