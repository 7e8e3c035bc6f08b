#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "daemon/tools/diagnosis/diagnose_output.h"

namespace framewatch::daemon {

/// A channel that reads more noise than is configured, densities in m/s^2/sqrt(Hz).
struct NoiseBeyond {
  std::size_t axis = 0;
  double configured = 0;
  double read = 0;  ///< quiet_noise_variance() of the quietest record
};

/// Channels that read more than twice the configured noise where no motion of a building is looked
/// for: what a diagnosis cannot explain may be that.
/// Accelerations alone.
std::vector<NoiseBeyond> noise_beyond_configured(
    const estimator::Plant& plant, const std::vector<estimator::RecordSegment>& segments);

/// The same in words, with what to do; empty where there is none, or nothing is left to explain.
std::string noise_sentence(const DiagnoseOutput& output);

}  // namespace framewatch::daemon
