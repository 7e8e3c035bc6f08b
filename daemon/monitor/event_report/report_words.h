#pragma once

#include <string>
#include <vector>

#include "estimator/shaking/placard.h"
#include "estimator/shaking/shaking.h"
#include "estimator/shaking/story_drift.h"
#include "estimator/shaking/story_response.h"

namespace framewatch::daemon {

/// "3.21 kN": a force in the unit that an engineer would write.
std::string force_words(double newton);
/// "1.73 %", "0.0421 %": three digits that count.
std::string drift_words(double ratio);
/// "1.23 kN along x, 56 N along y", of the directions that the structure has frames in.
std::string base_shear_words(const estimator::PeakResponse& peak,
                             const estimator::Structure& structure);

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

/// The parts of a strong motion for which there are no samples, one sentence each, without its full
/// stop: "Nobody listened from 10:03:12 to 10:03:40 (28 s): peaks in
/// that time are not known; drifts are known again from 10:03:50 on".
std::vector<std::string> unheard_sentences(const estimator::Shaking& shaking);
/// The total length of these parts: "28 s of it were not heard". Empty where there are none.
std::string unheard_words(const estimator::Shaking& shaking);
/// "restart", "restart_without_raw_samples", "no_samples".
const char* unheard_why(estimator::UnheardWhy why);

}  // namespace framewatch::daemon
