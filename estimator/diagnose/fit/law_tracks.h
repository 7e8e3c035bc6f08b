// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/free_run.h"
#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// The motion that drives the element laws of a model: the measured motion (equation by equation),
/// or the motion of the model's free run under the measured motion of the base.
enum class Forcing { measured, simulated };

/// Returns Forcing::simulated if the model has element laws; a linear model needs no free run.
Forcing forcing_of(const Model& model);

/// Returns motion and force of the model's element laws, or nullopt if the free run diverges.
/// `motion`: axes x bins, drives the laws if forcing is `measured`; empty: the calibrated readings.
/// `ratio`: steps per sample. `cache`: not shared between threads; null: no cache.
std::optional<std::vector<LawTrack>> tracks_of(const Plant& plant, const Model& model,
                                               const RecordSegment& segment, std::size_t record,
                                               Forcing forcing, const Eigen::MatrixXcd& motion,
                                               int ratio, RunCache* cache = nullptr);

/// The linear element nearest to the force of a law.
struct Equivalent {
  double stiffness = 0, damping = 0;  ///< N/m, N s/m
};

Equivalent equivalent_of(const LawTrack& track);
/// Returns the spectrum of a force minus that of a linear element. d: spectrum of its deformation,
/// m; w: rad/s.
Eigen::VectorXcd beyond(const Equivalent& linear, const Eigen::VectorXcd& force,
                        const Eigen::VectorXcd& d, const Eigen::VectorXd& w);

/// Returns the spectrum of an external harmonic force, N.
Eigen::VectorXcd harmonic_bins(const ModelEffect& effect, const RecordSegment& segment,
                               std::size_t record);

}  // namespace framewatch::estimator
