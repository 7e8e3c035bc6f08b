#pragma once

#include <vector>

#include "estimator/motion/derivative_triple.h"
#include "estimator/motion/sample.h"
#include "estimator/setup/pipeline_config.h"

// What the options of a SlidingWindowEstimator come to in samples: its windows in rows and in
// blocks of rows, and its derivatives. grouped: groups of stories are identified.
namespace framewatch::estimator {

/// advance: in samples.
DerivativeTriple triple_of(const EstimatorOptions& o, bool grouped, double advance);
/// By axis. Acquisition subtracts whole samples of a delay from the stamps; the triple undoes the
/// rest.
std::vector<DerivativeTriple> triples_of(const EstimatorOptions& o, bool grouped,
                                         const std::vector<SensorAxis>& axes);

int rows_of(double seconds, double rate);
SensorClock::duration duration_of(double rows, double rate_hz);
/// Of the other windows.
std::vector<int> blocks_of(const std::vector<double>& windows_s, double rate_hz, int block_rows);
/// Instants of motion that are kept beside the longest window: what the slowest possible row filter
/// of the paper's variant needs to settle; of the others, what windows are looked at again from.
int kept_beside(const EstimatorOptions& o, bool grouped);
/// In rows, the main window included.
int longest_window(int block_rows, const std::vector<int>& other_blocks);

}  // namespace framewatch::estimator
