// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/unknowns.h"
#include "estimator/diagnose/model/plant.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// One record of a building: all axes, calibrated.
struct RecordSamples {
  double rate_hz = 0;
  Eigen::MatrixXd accel;  ///< instants x axes, m/s^2, finite; a force axis, N, last
  /// Instants at the beginning that only start the simulation of a record that begins in motion.
  Eigen::Index lead = 0;
};

/// Input of a diagnosis.
struct DiagnosisInput {
  Plant plant;
  std::vector<RecordSegment> segments;  ///< of each record, in the band of the plant's frequencies
};

/// Returns stiffness and damping of the best-fitting linear model, theta order; empty if the fit
/// fails.
Eigen::VectorXd fitted_linear(const Plant& plant, const std::vector<RecordSegment>& segments,
                              const Tolerances& tolerances);

/// Returns plant and segments of one or more records. design: theta order, > 0; empty: estimated
/// from the records, starting from guessed_design(). Returns nullopt if a direction is measured
/// above the base but not at the base.
std::optional<DiagnosisInput> diagnosis_input(const Structure& structure,
                                              const std::vector<SensorAxis>& axes,
                                              const Eigen::VectorXd& design,
                                              const ComponentTest& component,
                                              const std::vector<RecordSamples>& records,
                                              const BendingStiffness& bending = {});

constexpr Eigen::Index kFewestBins = 30;  ///< of a segment, which is otherwise too short

enum class SegmentFault { none, too_short, no_excitation };

/// Returns why a segment cannot be diagnosed: fewer than kFewestBins frequencies in its band, or a
/// building's floor motion below the sensors' noise.
SegmentFault fault_of(const Plant& plant, const RecordSegment& segment,
                      const ComponentTest& component);

/// An axis above the base whose clock differs from the base's.
struct ClockOffset {
  Eigen::Index axis = 0, base = 0;
  double seconds = 0;  ///< by which the axis lags the base, beyond its configured delay
};

/// Returns axes whose clock differs from the base's along their direction by more than a quarter of
/// the lowest natural period; a fit cannot find such a delay. Uses motion slower than half of the
/// lowest natural frequency, where any building follows its base. Returns an empty list if there is
/// too little such motion.
std::vector<ClockOffset> clocks_apart(const Plant& plant, const RecordSegment& segment);

}  // namespace framewatch::estimator
