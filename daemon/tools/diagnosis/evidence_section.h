// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "daemon/tools/diagnosis/diagnose_verdict.h"

namespace framewatch::daemon {

// The parts of a report that a reader can check the diagnosis by. All return HTML except the
// sentences, which return text; all return "" if there is nothing to show.

/// Returns the force of every shown place over its deformation: measured, by the linear model, and
/// with the effects.
std::string force_section(const DiagnoseOutput& output);

/// Describes one of these forces: the largest values, and how far simulations are from measurement.
std::string force_sentence(const DiagnoseOutput& output, const estimator::PlaceForce& force);

/// Says how the measured force was computed, or why it is unknown.
std::string force_source(const DiagnoseOutput& output, const estimator::PlaceForce& force);

/// Returns the gap of the held-out records by frequency and by floor.
std::string gap_parts_section(const DiagnoseOutput& output);

/// Returns the autocorrelation of what the models leave.
std::string residual_section(const DiagnoseOutput& output);

/// Says if what is left has a pattern.
std::string residual_sentence(const DiagnoseOutput& output);

}  // namespace framewatch::daemon
