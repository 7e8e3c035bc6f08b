#pragma once

#include <string>
#include <vector>

#include "estimator/shaking/shaking.h"

namespace framewatch::daemon {

/// What of a strong motion is not known because no sample came or nobody listened, one sentence
/// without its full stop for each time: "Nobody listened from 10:03:12 to 10:03:40 (28 s): peaks in
/// that time are not known; drifts are known again from 10:03:50 on".
std::vector<std::string> unheard_sentences(const estimator::Shaking& shaking);
/// The same in a few words: "28 s of it were not heard"; empty: all was heard.
std::string unheard_words(const estimator::Shaking& shaking);
/// "restart", "restart_without_raw_samples", "no_samples".
const char* unheard_why(estimator::UnheardWhy why);

}  // namespace framewatch::daemon
