#include "estimator/identify/estimate/estimate.h"

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

}  // namespace framewatch::estimator
