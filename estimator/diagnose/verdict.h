#pragma once

#include <vector>

#include "estimator/diagnose/diagnosis.h"

namespace framewatch {

/// Misfit over what noise explains, below which nothing is missing.
constexpr double kAdequate = 1.25;

/// Gaps of one model's free runs, of each stretch that it can be run for.
std::vector<Gap> gaps_of(const Fitter& fitter, const Model& model);

/// Mean NRMSE over the stretches from `from` on; 0 when there is none.
double mean_gap(const std::vector<Gap>& gaps, std::size_t from);

/// Sets Diagnosis::before and after: gaps of models that have not seen the stretches from
/// `holdout_from` on.
void set_gaps(const Fitter& fitter, std::size_t holdout_from, Diagnosis& out);

/// Sets verdict and reason.
void judge(const Fitter& fitter, Diagnosis& out);

}  // namespace framewatch
