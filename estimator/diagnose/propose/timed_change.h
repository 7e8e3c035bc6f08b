#pragma once

#include <vector>

#include "estimator/diagnose/propose/needed_signal.h"

namespace framewatch::estimator {

/// Returns an effect of the form `changing` with the times of its stiffness change: its start and
/// duration in every record, with one amplitude for all records. sudden: the duration is fixed.
ModelEffect timed_change(const Fitter& fitter, const std::vector<NeededSignal>& needed,
                         ModelEffect effect, bool sudden);

}  // namespace framewatch::estimator
