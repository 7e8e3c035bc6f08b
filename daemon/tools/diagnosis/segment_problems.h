#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "estimator/diagnose/fit/diagnosis_input.h"

namespace framewatch::daemon {

/// Adds why one record of the input cannot be diagnosed, and what to measure instead: too few
/// frequencies, motion below the sensors' noise, channels whose clocks are apart.
void add_segment_problems(const std::string& path, const estimator::DiagnosisInput& input,
                          std::size_t record, const estimator::ComponentTest& component,
                          std::vector<std::string>& problems);

}  // namespace framewatch::daemon
