#pragma once

#include <optional>

#include "estimator/diagnose/fit/unknowns.h"
#include "estimator/diagnose/fit/whitened.h"

namespace framewatch::estimator {

/// Returns true if the derivative of the free run's motion by this unknown is computed: for
/// parameters of effects, and for stiffness and mass of frames in the direction of a law's frame.
/// In a large building only for stiffnesses at the law and next to it.
bool moves_run(const Plant& plant, const Model& model, const Unknown& unknown);

/// Returns the derivative of the whitened equations by one unknown through the forces of the laws,
/// or nullopt if the changed model cannot be run. The laws' motion is that of the free run. system:
/// of the model, whitened with Forcing::simulated. cache: not shared between threads; null: no
/// cache.
std::optional<Eigen::VectorXd> run_column(const Plant& plant, const Model& model,
                                          const RecordSegment& segment, std::size_t record,
                                          const Whitened& system, const Unknown& unknown, int ratio,
                                          RunCache* cache = nullptr);

}  // namespace framewatch::estimator
