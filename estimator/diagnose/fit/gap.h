// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/whitened.h"
#include "estimator/diagnose/model/plant.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Returns true if a free run's motion is compared with the axis: a floor's axis, or the force axis
/// if a component's motion is prescribed.
bool is_output(const Plant& plant, Eigen::Index axis);

/// Returns the segments with an error of the model added to the sensors' noise. The error is equal
/// on every output axis and in every bin: `share` (NRMSE, as Gap::overall) of the outputs' rms in
/// the band of each segment. With these weights a fit minimizes the gap of the free run.
std::vector<RecordSegment> with_model_error(const Plant& plant,
                                            const std::vector<RecordSegment>& segments,
                                            double share);

/// Difference between a model's free run and the measurement: NRMSE, sqrt(sum |meas - sim|^2 / sum
/// |meas|^2) over the band, and its value from the sensors' noise alone (floor). The overall sums
/// are over all output axes.
struct Gap {
  Eigen::VectorXd axis;   ///< 0 for base axes
  Eigen::VectorXd floor;  ///< of each axis
  double overall = 0;
  double overall_floor = 0;
  double measured_rms = 0;  ///< the denominator of `overall`, rms of an output axis in the band
  double worst = 0;
  int worst_axis = -1;
  Eigen::MatrixXcd difference;  ///< axes x bins: measured minus simulated
  Eigen::MatrixXd noise;  ///< axes x bins: expected |difference|^2 from the sensors' noise alone
};

/// Returns the gap of one segment, or nullopt if the run diverges. This is the only definition of
/// the gap: motion before and after the segment (end terms, docs/equations.md 32) is chosen to
/// minimize the difference. record: its index; ratio: steps per sample.
std::optional<Gap> free_run_gap(const Plant& plant, const Model& model,
                                const RecordSegment& segment, std::size_t record, int ratio);

/// Returns the gap with the end terms of the weights of `system`. system: of the model, whitened
/// with Forcing::simulated. Estimates arbitrary forces (LawForm::broadband) from the record.
/// Compares a clipped axis with the clipped simulation.
Gap gap_of(const Plant& plant, const Model& model, const RecordSegment& segment,
           const Whitened& system);

/// Returns the mean NRMSE over the segments from `from` on; 0 without segments.
double mean_gap(const std::vector<Gap>& gaps, std::size_t from);
/// Returns the mean floor over the segments from `from` on; 0 without segments.
double mean_floor(const std::vector<Gap>& gaps, std::size_t from);

}  // namespace framewatch::estimator
