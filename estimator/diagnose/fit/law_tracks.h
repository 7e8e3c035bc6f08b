#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/free_run.h"
#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Which motion drives the element laws of a model: the measured one (equation by equation), or
/// that of the model's own free run under the measured motion of the base.
enum class Forcing { measured, simulated };

/// The free run where a model has element laws; a linear model needs none.
Forcing forcing_of(const Model& model);

/// Motion and force of the model's element laws. motion: axes x bins that drives them when forcing
/// is `measured`; empty: the calibrated readings. Empty when the free run diverges.
/// cache: of one thread; null: none.
std::optional<std::vector<LawTrack>> tracks_of(const Plant& plant, const Model& model,
                                               const RecordSegment& segment, std::size_t record,
                                               Forcing forcing, const Eigen::MatrixXcd& motion,
                                               int ratio, RunCache* cache = nullptr);

/// The linear element nearest to the force of a law.
struct Equivalent {
  double stiffness = 0, damping = 0;  ///< N/m, N s/m
};

Equivalent equivalent_of(const LawTrack& track);
/// Spectrum of a force minus that of a linear element. d: spectrum of its deformation, m; w: rad/s.
Eigen::VectorXcd beyond(const Equivalent& linear, const Eigen::VectorXcd& force,
                        const Eigen::VectorXcd& d, const Eigen::VectorXd& w);

/// Spectrum of a harmonic force from outside, N.
Eigen::VectorXcd harmonic_bins(const ModelEffect& effect, const RecordSegment& segment,
                               std::size_t record);

}  // namespace framewatch::estimator
