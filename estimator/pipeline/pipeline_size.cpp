// SPDX-License-Identifier: MIT
#include "estimator/pipeline/pipeline_size.h"

#include <algorithm>
#include <cmath>

namespace framewatch::estimator {
namespace {

constexpr double kNumber = sizeof(double);
constexpr double kBlocksOfWindow = 20, kFewestBlocks = 4;  // as SlidingWindowEstimator has them
constexpr double kColumns = 40;        // of BatchMeans: blocks and perturbed designs
constexpr double kVectorHead = 40;     // a small vector's own bytes and malloc's
constexpr double kPerParameter = 220;  // of a WindowEstimate and of a solution

/// The sizes of an estimation, as doubles: absurd options must not overflow an integer.
struct Sizes {
  explicit Sizes(const PipelineConfig& c)
      : options(c.options),
        floors(c.structure.stories),
        frames(c.structure.frames()),
        own(2.0 * frames + 2.0 * c.structure.panels()),
        front(own + 2 * frames + 1),
        axes(static_cast<double>(c.axes.size())) {
    gram = floors * (front * front / 2 + 4.5 * front);
    block_rows = std::max(2.0, std::round(options.window_s * options.rate_hz / kBlocksOfWindow));
    held_blocks = kBlocksOfWindow;
    for (const double s : options.other_windows_s)
      held_blocks =
          std::max({held_blocks, kFewestBlocks, std::round(s * options.rate_hz / block_rows)});
    windows = 1.0 + static_cast<double>(options.other_windows_s.size());
    const bool standby = options.self_tune && options.variant == Variant::matched;
    regressions = standby ? 2 : 1;
  }

  const EstimatorOptions& options;
  double floors, frames, own, front, axes;
  double gram = 0;  ///< packed sums of one window, numbers
  double block_rows = 0, held_blocks = 0, windows = 0, regressions = 0;
};

double sums_of(const Sizes& s) {
  const double held = 4 + s.held_blocks + (s.block_rows - 1) + 2 * (s.windows - 1);
  const double stored = s.floors * s.frames * (s.front + 2) * s.block_rows;
  const double long_window = s.options.long_window_s > 0 ? kBlocksOfWindow + 3 : 0;
  return kNumber * (s.regressions * (s.gram * held + stored) + s.gram * long_window);
}

double solvers_of(const Sizes& s) {
  const double windows = s.windows + (s.options.long_window_s > 0 ? 1 : 0);
  const double unknowns = s.floors * s.own;
  const double window = s.floors * 2.2 * s.front * s.front + s.gram + unknowns * kColumns;
  const double tuning = s.floors * s.front * (4 * s.front + 6 * s.frames);
  return kNumber * (windows * window + s.regressions * tuning) +
         (windows + 1) * unknowns * kPerParameter;
}

double motion_of(const Sizes& s) {
  const EstimatorOptions& o = s.options;
  const double slowest_s = 3 / (std::min(o.filter_damping, 0.7) * 2 * M_PI * o.high_pass_hz);
  const double warm_up =
      std::max(o.settle_s, slowest_s) * o.rate_hz + s.held_blocks * s.block_rows + 16;
  const double instant =
      kNumber * s.floors * (s.own + s.frames) + (s.floors + 1) * s.frames + 4 * kVectorHead;
  return 2 * warm_up * instant;
}

}  // namespace

PipelineSize pipeline_size(const PipelineConfig& config) {
  const Sizes s(config);
  const EstimatorOptions& o = s.options;
  PipelineSize out;
  out.sums = sums_of(s);
  out.solvers = solvers_of(s);
  out.motion = motion_of(s);
  out.noise = kNumber * s.regressions * 3 * 3 * o.rate_hz / o.high_pass_hz;
  out.boxplots = kNumber * s.floors * s.own * (2.2 * o.boxplot_windows + 16);
  out.open = (o.lateness_s * o.rate_hz + 8) * (9 * s.axes + 4 * kVectorHead);
  return out;
}

}  // namespace framewatch::estimator
