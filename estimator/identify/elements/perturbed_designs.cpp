#include "estimator/identify/elements/perturbed_designs.h"

#include "estimator/identify/elements/fixed_signs.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::estimator {
namespace {

/// Standard deviation of a design that is off by anything up to its tolerance, over the tolerance.
constexpr double kUniform = 0.58;

}  // namespace

PerturbedDesigns::PerturbedDesigns(const FloorLayout& layout) : own_(layout.own()) {
  for (int u = 0; u < layout.unknowns(); ++u)
    for (int c = 0; c < kCount; ++c)
      error_.push_back(kUniform * design_tolerance(layout.kind(u % own_)) * fixed_sign(u, c));
}

}  // namespace framewatch::estimator
