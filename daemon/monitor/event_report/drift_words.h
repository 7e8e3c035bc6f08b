#pragma once

#include <string>

#include "daemon/monitor/event_report/response_words.h"
#include "estimator/shaking/placard.h"
#include "estimator/shaking/story_drift.h"

namespace framewatch::daemon {

/// "slight", "moderate", "extensive", "complete".
const char* state_word(estimator::DamageState state);
/// "35 %", "less than 1 %", "more than 99 %", "-" of NaN.
std::string probability_words(double probability);
/// The first letter large.
std::string capitalised(std::string text);
/// "inspected", "restricted use", "restricted use (not judged)", "unsafe".
std::string placard_words(const estimator::PlacardChoice& choice);
/// "INDICATION: an engineer decides after an inspection." in one sentence.
const char* placard_caution();
/// "1.20 % ± 0.10 %"; "not known".
std::string drift_with_error(const estimator::StoryDrift& drift);

}  // namespace framewatch::daemon
