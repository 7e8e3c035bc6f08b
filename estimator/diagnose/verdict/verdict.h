#pragma once

#include <vector>

#include "estimator/diagnose/fit/fit.h"
#include "estimator/diagnose/verdict/diagnosis.h"

namespace framewatch::estimator {

const char* verdict_word(Verdict verdict);

/// Ratio of misfit to its expectation below which a model is adequate.
constexpr double kAdequate = 1.25;

/// Gap of a model's free run of each segment; segments whose run diverges are left out.
std::vector<Gap> gaps_of(const Fitter& fitter, const Model& model);

/// Mean NRMSE over the segments from `from` on; 0 when there is none.
double mean_gap(const std::vector<Gap>& gaps, std::size_t from);

/// Sets Diagnosis::before and after: gaps of models fitted without the segments from `holdout_from`
/// on.
void set_gaps(const Fitter& fitter, std::size_t holdout_from, Diagnosis& out);

/// Sets Diagnosis::verdict and reason.
void judge(const Fitter& fitter, Diagnosis& out);

}  // namespace framewatch::estimator
