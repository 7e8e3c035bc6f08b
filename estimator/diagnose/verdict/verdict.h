#pragma once

#include <cstddef>
#include <vector>

#include "estimator/diagnose/fit/judged_fit.h"
#include "estimator/diagnose/verdict/diagnosis.h"

namespace framewatch::estimator {

const char* verdict_word(Verdict verdict);

/// Ratio of misfit to its expectation below which a model is adequate.
constexpr double kAdequate = 1.25;

/// Whether every segment fits a linear building of its own, and not one together. linear: the model
/// of all.
bool fits_separately(const Fitter& fitter, const Model& linear, double ratio_before);

/// Marks the effects as approximate where more than noise is left, beyond chance.
void mark_approximate(const Fitter& fitter, Diagnosis& out);

/// The model without the effects from `first` on.
Model with_first(const Model& model, const std::vector<FoundEffect>& effects, std::size_t first,
                 const Plant& plant);

/// Sets Diagnosis::before and after, and before and after of its effects in their order: gaps of
/// models fitted to the segments before `options.holdout_from` alone, as they are judged
/// (judged_fit).
void set_gaps(const Fitter& fitter, const DiagnosisOptions& options, Diagnosis& out);

/// Sets Diagnosis::leading from its rejected trials; after set_gaps().
void set_leading(const Fitter& fitter, const DiagnosisOptions& options, Diagnosis& out);

/// Takes every name back whose model is worse than none: a gap above 100 % in any record, or, held
/// out, above the one before by more than a tenth; and that of a law of one place that is alone,
/// leaves a held-out gap of more than 2.5 times its floor, and is not of the kind that the force
/// there is known to be. Whether it did.
bool withdraw_worse(std::size_t holdout_from, Diagnosis& out);

/// How far a name is to be trusted.
enum class Grade {
  established,  ///< nothing else comes near, and nothing but noise is left beside it
  leading,      ///< the best of several, or of what is left something else is the cause
};
Grade grade_of(const FoundEffect& effect);
const char* grade_word(Grade grade);

/// Sets Diagnosis::verdict and reason.
void judge(const Fitter& fitter, Diagnosis& out);

}  // namespace framewatch::estimator
