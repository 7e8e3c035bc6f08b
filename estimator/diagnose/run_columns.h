#pragma once

#include <optional>

#include "estimator/diagnose/fit.h"

namespace framewatch {

/// Whether an unknown changes the motion of a free run so much that a fit has to know it: the
/// stiffness and mass of the frames along a law's, and what effects have.
bool moves_run(const Plant& plant, const Model& model, const Unknown& unknown);

/// What one unknown changes in the whitened equations through the forces of the laws, which act on
/// the motion of the free run and change it. system: of the model, whitened with
/// Forcing::simulated. Empty when the changed model cannot be run.
std::optional<Eigen::VectorXd> run_column(const Plant& plant, const Model& model,
                                          const Stretch& stretch, std::size_t record,
                                          const Whitened& system, const Unknown& unknown,
                                          int ratio);

}  // namespace framewatch
