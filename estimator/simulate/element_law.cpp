#include "estimator/simulate/element_law.h"

namespace framewatch::estimator {

void ElementLaw::rates(double, double, std::span<const double>, std::span<double>) const {}

void ElementLaw::begin_step(double, double) {}

}  // namespace framewatch::estimator
