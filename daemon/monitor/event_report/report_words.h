// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "estimator/shaking/placard.h"
#include "estimator/shaking/shaking_watch.h"
#include "estimator/shaking/story_drift.h"
#include "estimator/shaking/story_response.h"

namespace framewatch::daemon {

/// Returns a force in the unit that an engineer would write: "3.21 kN".
std::string force_words(double newton);
/// Returns a drift ratio in percent with three significant digits: "1.73 %", "0.0421 %".
std::string drift_words(double ratio);
/// Returns "1.23 kN along x, 56 N along y" for the directions in which the structure has frames.
std::string base_shear_words(const estimator::PeakResponse& peak,
                             const estimator::Structure& structure);

/// Returns "slight", "moderate", "extensive" or "complete".
const char* state_word(estimator::DamageState state);
/// Returns "35 %", "less than 1 %", "more than 99 %", or "-" for NaN.
std::string probability_words(double probability);
/// Returns the text with its first letter in upper case.
std::string capitalized(std::string text);
/// Returns "inspected", "restricted use", "restricted use (not judged)" or "unsafe".
std::string placard_words(const estimator::PlacardChoice& choice);
/// Returns the caution that a placard is an indication and an engineer decides after an inspection.
const char* placard_caution();
/// Returns a drift with its standard error: "1.20 % ± 0.10 %"; "not known" for an unknown drift.
std::string drift_with_error(const estimator::StoryDrift& drift);

/// Returns one sentence, without its full stop, for each part of a strong motion without samples.
/// Example: "Nobody listened from 10:03:12 to 10:03:40 (28 s): peaks in that time are not known;
/// drifts are known again from 10:03:50 on".
std::vector<std::string> unheard_sentences(const estimator::Shaking& shaking);
/// Returns the total length of these parts, "28 s of it were not heard"; empty if all samples came.
std::string unheard_words(const estimator::Shaking& shaking);
/// Returns "restart", "restart_without_raw_samples" or "no_samples".
const char* unheard_why(estimator::UnheardWhy why);

}  // namespace framewatch::daemon
