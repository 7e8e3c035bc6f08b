#pragma once

#include <vector>

#include "estimator/diagnose/propose/needed_signal.h"

namespace framewatch::estimator {

/// An effect of the form `changing` with the times of its stiffness change: when it begins and how
/// long it lasts in every record, its amplitude shared by the records. sudden: its length is fixed.
ModelEffect timed_change(const Fitter& fitter, const std::vector<NeededSignal>& needed,
                         ModelEffect effect, bool sudden);

}  // namespace framewatch::estimator
