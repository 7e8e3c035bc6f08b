#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/fit/whitened.h"

namespace framewatch::estimator {

/// Disagreement of a model's free run and the measurement: NRMSE, sqrt(sum |meas - sim|^2 / sum
/// |meas|^2) over the band, and the value that the sensors' noise alone would give (floor). Overall
/// both sums are over all output axes.
struct Gap {
  Eigen::VectorXd axis;   ///< base axes: 0
  Eigen::VectorXd floor;  ///< of each axis
  double overall = 0;
  double overall_floor = 0;
  double measured_rms = 0;  ///< the denominator of `overall`, rms of an output axis in the band
  double worst = 0;
  int worst_axis = -1;
  Eigen::MatrixXcd difference;  ///< axes x bins: measured minus simulated
};

/// The gap of one segment, the only definition of it: motion before and after the segment (end
/// terms, docs/equations.md 32) is what leaves least of the difference. record: its index; ratio:
/// steps per sample. Empty when the run diverges.
std::optional<Gap> free_run_gap(const Plant& plant, const Model& model,
                                const RecordSegment& segment, std::size_t record, int ratio);

/// The same with end terms as the weights of `system` have them.
/// system: of the model, whitened with Forcing::simulated. Arbitrary forces (LawForm::broadband)
/// are estimated from the record; a clipped axis is compared with the clipped simulation.
Gap gap_of(const Plant& plant, const Model& model, const RecordSegment& segment,
           const Whitened& system);

/// Mean NRMSE over the segments from `from` on; 0 when there is none.
double mean_gap(const std::vector<Gap>& gaps, std::size_t from);
/// The same of what noise alone would give.
double mean_floor(const std::vector<Gap>& gaps, std::size_t from);

}  // namespace framewatch::estimator
