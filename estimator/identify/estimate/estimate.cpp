// SPDX-License-Identifier: MIT
#include "estimator/identify/estimate/estimate.h"

#include <cmath>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {

WindowEstimate::WindowEstimate(std::size_t parameters) {
  for (std::vector<double>* v : {&value, &std_error, &snr, &amplitude, &prior_share, &noise_share,
                                 &last_value, &last_std_error, &solution})
    v->assign(parameters, kNaN);
  last_end.resize(parameters);
  reason.assign(parameters, Observability::warming_up);
  boxplot.assign(parameters, BoxplotStatistics{kNaN, kNaN, kNaN, kNaN, kNaN, 0, 0});
}

ModelFit::ModelFit(std::size_t parameters) : word(parameters, FitWord::unknown) {
  for (std::vector<double>* v : {&misfit, &design_error, &misfit_error, &corner_error, &error})
    v->assign(parameters, kNaN);
}

FitWord fit_word(double misfit) {
  if (std::isnan(misfit)) return FitWord::unknown;
  return misfit > ModelFit::kNothing       ? FitWord::does_not_fit
         : misfit > ModelFit::kOnlyChanges ? FitWord::only_changes
                                           : FitWord::fits;
}

}  // namespace framewatch::estimator
