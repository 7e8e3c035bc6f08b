#pragma once

#include <string>

#include "daemon/event_report/drift_report.h"
#include "daemon/event_report/response_words.h"

namespace framewatch::daemon {

/// "slight", "moderate", "extensive", "complete".
const char* state_word(estimator::DamageState state);
/// "35 %", "less than 1 %", "more than 99 %", "-" of NaN.
std::string probability_words(double probability);
/// The first letter large.
std::string capitalised(std::string text);

}  // namespace framewatch::daemon
