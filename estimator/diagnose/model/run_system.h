// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/modal_system.h"
#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

/// Equation of motion of a model's free run, M y'' + C y' + K y = P u. Coordinates: the building's,
/// then one for every resonator. Inputs u: the driving axes (base acceleration, m/s^2, or a
/// measured force, N), then the force, N, of every effect that is an element law or a harmonic
/// force.
struct RunSystem {
  Eigen::MatrixXd mass, damping, stiffness;  ///< coordinates x coordinates
  Eigen::MatrixXd inputs;                    ///< P, coordinates x inputs
};

/// Returns the equation of motion of a model. driving: axes that drive the run.
RunSystem run_system(const Plant& plant, const Model& model,
                     const std::vector<Eigen::Index>& driving);

/// Caches what free runs share if their models differ only in laws: the modes of the linear
/// building, which take longer than the run in a large building, and the driving signals. Results
/// do not depend on it.
class RunCache {
 public:
  /// Returns the modes at rest, for steps of step_s. Caches those of the last parts.
  const ModalSystem& modes(const RunSystem& parts, double step_s);
  /// Returns how often modes were computed.
  int computed() const { return computed_; }
  /// Returns the readings of a record's driving axes at every step, the lead first, corrected for
  /// the model's gains and clocks: axes x steps. Caches the signals of the last gains and clocks.
  const Eigen::MatrixXd& driving(const Model& model, const RecordSegment& segment,
                                 std::size_t record, const std::vector<Eigen::Index>& axes,
                                 int ratio);

 private:
  struct Modes {
    RunSystem parts;
    double step_s;
    ModalSystem system;
  };
  struct Driving {
    Eigen::VectorXd errors;
    int ratio;
    Eigen::MatrixXd signals;
  };

  int computed_ = 0;
  std::optional<Modes> modes_;
  std::map<std::size_t, Driving> driving_;  ///< by record
};

}  // namespace framewatch::estimator
