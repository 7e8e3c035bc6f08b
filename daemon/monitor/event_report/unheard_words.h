#pragma once

#include <string>
#include <vector>

#include "estimator/shaking/shaking_watch.h"

namespace framewatch::daemon {

/// The parts of a strong motion for which there are no samples, one sentence each, without its full
/// stop: "Nobody listened from 10:03:12 to 10:03:40 (28 s): peaks in
/// that time are not known; drifts are known again from 10:03:50 on".
std::vector<std::string> unheard_sentences(const estimator::Shaking& shaking);
/// The total length of these parts: "28 s of it were not heard". Empty where there are none.
std::string unheard_words(const estimator::Shaking& shaking);
/// "restart", "restart_without_raw_samples", "no_samples".
const char* unheard_why(estimator::UnheardWhy why);

}  // namespace framewatch::daemon
