#include "estimator/identify/window/late_windows.h"

#include <cmath>

namespace framewatch::estimator {

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
  estimate_.start =
      window_end - SensorClock::duration(std::llround((estimate_.rows - 1) * 1e6 / rate_hz_));
  ++estimate_.sequence;
  series_.main().fill({&regression.tuning().theta0(), &set.known, true}, estimate_);
  for (int p = 0; p < drift_.elements(); ++p)
    estimate_.amplitude[static_cast<std::size_t>(p)] = drift_.rms(p, blocks_);
  given.main = &estimate_;
  return given;
}

}  // namespace framewatch::estimator
