// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/model/plant.h"
#include "estimator/diagnose/spectra/record_segment.h"
#include "estimator/structure/effect.h"

namespace framewatch::estimator {

/// A restoring force over the deformation under it, one value per sample.
struct ForceCurve {
  Eigen::VectorXd d_m, force_n;
};

/// Measured and simulated force of an element, or of a law between floors, in one record.
///
/// The measured force is what the equations of motion leave to this place: the inertia of the
/// floors above a frame's story, less the forces of its neighbors by the model (`modelled_share`).
/// At other places it is the inertia of the floors there, less the forces of all other elements.
/// The simulated forces are of free runs under the measured motion of the base alone.
struct PlaceForce {
  EffectPlace place;        ///< an element, or two floors
  std::size_t record = 0;   ///< index of the segment
  bool is_element = false;  ///< false: a law alone acts there, without a spring or dashpot
  bool has_law = false;     ///< of the model with the effects
  bool measured = false;    ///< false: no sensors read the deformation or the inertia
  /// Frequencies of forces and deformations: from the lower end of the band to half the sampling
  /// rate, because a law makes harmonics. In large buildings and component tests only the band.
  double low_hz = 0, high_hz = 0;
  bool of_direction = false;  ///< floors are rigid: inertia of all frames of the direction
  /// The strongest motion; `from_s` is its start in the segment. A curve is empty if it is not
  /// known: not measured, or the run diverges.
  double from_s = 0, to_s = 0;
  ForceCurve measurement, linear, with_effects;
  // Over the whole segment, without two periods of low_hz at its ends, where integrals err:
  double peak_d_m = 0;  ///< largest deformation: measured, else with the effects
  double measured_n = 0, linear_n = 0, with_effects_n = 0;  ///< largest forces
  /// The rms difference between measured and simulated force over the rms of the measured force.
  double linear_off = 0, with_effects_off = 0;
  double measured_rms_n = 0;
  double noise_n = 0;         ///< rms of the sensors' noise in the measured force
  double modelled_share = 0;  ///< rms of the measured force's part from the model over its rms
};

/// Returns the force at a place: a frame story, a panel, or a node or two floors with a law; of a
/// whole frame or direction, the element whose law is strongest. Returns nullopt at other places,
/// and if neither model nor measurement gives a force. linear, model: without and with the effects.
/// record: the segment's index.
std::optional<PlaceForce> force_at(const Plant& plant, const Model& linear, const Model& model,
                                   const RecordSegment& segment, std::size_t record,
                                   const EffectPlace& place);

}  // namespace framewatch::estimator
