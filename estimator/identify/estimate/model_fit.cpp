#include "estimator/identify/estimate/model_fit.h"

#include <cmath>

#include "estimator/numeric/nan.h"

namespace framewatch::estimator {

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
