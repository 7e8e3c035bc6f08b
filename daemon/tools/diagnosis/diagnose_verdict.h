#pragma once

#include <string>

#include "daemon/tools/diagnosis/diagnose_output.h"

namespace framewatch::daemon {

// A diagnosis in words for people who look after the building; all of it is text, not HTML.

/// What is missing, and where, in one sentence.
std::string verdict_sentence(const DiagnoseOutput& output);

/// The one figure of the gap: free-run NRMSE of the records that nothing was fitted to, before and
/// after, beside its floor.
std::string gap_sentence(const DiagnoseOutput& output);

/// What every overall gap is a share of, and its unit.
/// What drives every free run: "motion of the base", "force", or both.
std::string driver_words(const DiagnoseOutput& output);

std::string denominator_words(const DiagnoseOutput& output);
const char* gap_unit(const DiagnoseOutput& output);

/// "something like bouc wen at story 1, frame y1 (gradual yielding)".
std::string effect_words(const DiagnoseOutput& output, const estimator::FoundEffect& effect);

/// Part of the held-out gap before, 0..1, that a fall of the gap is.
double share_of_gap(const DiagnoseOutput& output, double fall);

/// The modes' damping ratios beside the dashpots; empty where there are none.
std::string damping_sentence(const DiagnoseOutput& output);

/// What the best law does that was not named; empty where there is none.
std::string leading_sentence(const DiagnoseOutput& output);

/// How sure its name is.
std::string confidence_words(const estimator::FoundEffect& effect);

/// What the command prints: all of these.
std::string diagnosis_text(const DiagnoseOutput& output);

/// "12.34 %".
std::string gap_percent(double share);
/// With a capital letter at the beginning.
std::string with_capital(std::string text);

}  // namespace framewatch::daemon
