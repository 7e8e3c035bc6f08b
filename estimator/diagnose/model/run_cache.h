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

/// What free runs have in common whose models differ in their laws alone: the modes of the linear
/// building, which in a large one take longer than the run, and the driving signals. Results are
/// those without it.
class RunCache {
 public:
  /// At rest, steps of step_s; those of the last parts are kept.
  const ModalSystem& modes(const RunSystem& parts, double step_s);
  /// How often modes were computed.
  int computed() const { return computed_; }
  /// Readings of the driving axes of a record at every step, the lead first, without the model's
  /// errors of gain and clock: axes x steps; those of the last such errors are kept.
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
