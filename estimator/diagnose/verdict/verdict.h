// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "estimator/diagnose/fit/judged_fit.h"
#include "estimator/diagnose/verdict/diagnosis.h"

namespace framewatch::estimator {

const char* verdict_word(Verdict verdict);

/// Returns true if every segment fits a separate linear building, but not one common building.
/// linear: the model of all segments.
bool fits_separately(const Fitter& fitter, const Model& linear, double ratio_before);

/// Marks the effects as approximate, and doubts them, if more than noise is left: a misfit beyond
/// chance, and in one record a gap above its floor. A law whose computed force is off by a
/// thousandth leaves such a misfit in strong motion, but no gap. Needs Diagnosis::after.
void mark_approximate(const Fitter& fitter, Diagnosis& out);

/// Sets Diagnosis::before and after, and before and after of its effects in their order: the gaps
/// of models fitted by judged_fit() to the segments before `options.holdout_from`.
void set_gaps(const Fitter& fitter, const DiagnosisOptions& options, Diagnosis& out);

/// Sets the same from the models of all segments as they are.
void set_gaps_of_all(const Fitter& fitter, std::size_t holdout_from, Diagnosis& out);

/// Sets Diagnosis::leading from its rejected trials. Call it after set_gaps().
void set_leading(const Fitter& fitter, const DiagnosisOptions& options, Diagnosis& out);

/// Withdraws every name if the model is worse than the one without: a gap above 100 % in any
/// record, or a held-out gap more than a tenth larger. Also withdraws a single law at one place
/// that leaves a held-out gap above 2.5 times its floor and is not of the known kind of force
/// there. Returns true if it withdrew names.
bool withdraw_worse(const SearchSettings& settings, std::size_t holdout_from, Diagnosis& out);

/// Confidence grade of a name.
enum class Grade {
  established,  ///< no rival comes near, and only noise is left
  leading,      ///< the best of several, or another cause remains in the residual
};
/// Confidence from which on a name is established.
inline constexpr double kEstablished = 0.95;
Grade grade_of(const FoundEffect& effect);
const char* grade_word(Grade grade);

/// Sets Diagnosis::verdict and reason.
void judge(const Fitter& fitter, Diagnosis& out);

/// Subtracts the ramps of the configuration (DiagnosisOptions::known) and those it finds from the
/// segments. Returns the ramps that it found.
std::vector<FoundEffect> remove_ramps(const Plant& plant, const DiagnosisOptions& options,
                                      std::vector<RecordSegment>& segments);

/// Adds the ramps, which lie below the band, to the gap before the diagnosis.
void add_ramps_to_gaps(const Plant& plant, const std::vector<RecordSegment>& segments,
                       std::size_t holdout_from, Diagnosis& diagnosis);

}  // namespace framewatch::estimator
