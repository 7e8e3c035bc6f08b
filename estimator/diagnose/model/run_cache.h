#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/diagnose/model/modal_system.h"
#include "estimator/diagnose/model/model.h"
#include "estimator/diagnose/model/run_system.h"
#include "estimator/diagnose/spectra/record_segment.h"

namespace framewatch::estimator {

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
