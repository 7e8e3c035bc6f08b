#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/unknowns.h"
#include "estimator/diagnose/model/component_test.h"
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

/// What a diagnosis works on.
struct DiagnosisInput {
  Plant plant;
  std::vector<RecordSegment> segments;  ///< of each record, in the band of the plant's frequencies
};

/// Stiffness and damping of the linear model that fits best, theta order; empty when none does.
Eigen::VectorXd fitted_linear(const Plant& plant, const std::vector<RecordSegment>& segments,
                              const Tolerances& tolerances);

/// Plant and segments of records (at least one). design: theta order, > 0; empty: estimated from
/// the records, beginning with guessed_design(). Empty when the base is not measured in a direction
/// that is measured above it.
std::optional<DiagnosisInput> diagnosis_input(const Structure& structure,
                                              const std::vector<SensorAxis>& axes,
                                              const Eigen::VectorXd& design,
                                              const ComponentTest& component,
                                              const std::vector<RecordSamples>& records,
                                              const BendingStiffness& bending = {});

constexpr Eigen::Index kFewestBins = 30;  ///< of a segment, else it is too short

enum class SegmentFault { none, too_short, no_excitation };

/// Why a segment cannot be diagnosed: fewer than kFewestBins frequencies in its band, or, of a
/// building, a floor motion that does not exceed the sensors' noise.
SegmentFault fault_of(const Plant& plant, const RecordSegment& segment,
                      const ComponentTest& component);

/// An axis above the base whose clock is not the base's.
struct ClockOffset {
  Eigen::Index axis = 0, base = 0;
  double seconds = 0;  ///< that the axis reads later than the base, its configured delay apart
};

/// Axes that read later or earlier than the base along their direction by more than a quarter of
/// the lowest natural period, beyond which no fit finds a delay. From motion slower than half of
/// the lowest natural frequency, where a building goes with its base whatever it is made of; none
/// where there is too little of it to tell.
std::vector<ClockOffset> clocks_apart(const Plant& plant, const RecordSegment& segment);

}  // namespace framewatch::estimator
