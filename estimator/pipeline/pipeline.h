// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "estimator/state/abi.h"

#include "estimator/identify/estimate/estimate.h"
#include "estimator/motion/axis_counters.h"
#include "estimator/motion/pulled.h"
#include "estimator/motion/sample.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/state/archive.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Counts what a pipeline has done since its construction.
struct PipelineCounters {
  std::int64_t sample_sets = 0;    ///< merged instants
  std::int64_t interruptions = 0;  ///< breaks that restarted the window
  std::int64_t windows = 0;        ///< estimates of the main window
  std::int64_t retunes = 0;        ///< times the filters were re-tuned
  std::vector<AxisCounters> axes;  ///< by configured axis
};

/// One result of a pipeline; pointers are null for what it does not have.
struct PipelineResult {
  /// A calibrated instant. It comes before the estimates that it completes.
  const SampleSet* instant = nullptr;
  /// It is the instant without the axes of leave_out().
  const SampleSet* trusted = nullptr;
  /// The estimate of the main window that ends now.
  const WindowEstimate* estimate = nullptr;
  /// The estimate of a window of another length (EstimatorOptions::other_windows_s).
  const WindowEstimate* other = nullptr;
  /// How far the model may be wrong, once per window length.
  const ModelFit* model = nullptr;
  /// The estimate of a window that was held back while the filters were not tuned to the building.
  /// It ends in the past.
  const WindowEstimate* late = nullptr;
};

/// Turns samples into window estimates. Reads no clock, never throws and allocates nothing after
/// construction. Long computations are spread over instants by their count (docs/performance.md).
class Pipeline {
 public:
  /// The results of one push() or finish().
  using Results = Pulled<Pipeline, PipelineResult>;

  /// Precondition: problems(config) is empty.
  explicit Pipeline(const PipelineConfig& config);
  ~Pipeline();

  /// Tunes the row filters, as after a pass over the same record. Call it before the first sample,
  /// with the tuning of a pipeline that has the same structure and axes. Does nothing without
  /// options.self_tune.
  void start_tuned(const Tuning& tuning);
  /// Returns what the row filters are tuned to. Returns nullopt while the noise of an axis is not
  /// known, and without options.self_tune.
  std::optional<Tuning> tuning() const;

  /// Takes a sample of one axis at one instant, in any order within options.lateness_s. Returns the
  /// results it completes, in their order; the caller may ignore them.
  Results push(const AccelSample& sample);
  /// Ends the input: closes the instants still open, and returns their results.
  Results finish();
  /// Leaves these axes out of the estimates from the next instant on, as if they delivered nothing.
  /// If one more is left out than before, its earlier samples were wrong too: all windows begin
  /// anew. left_out: by axis, 1: left out.
  void leave_out(const std::vector<std::uint8_t>& left_out);
  /// Returns the next result of the newest push() or finish(), valid until the next call, or null.
  const PipelineResult* next();

  /// Returns the table of the identified parameters. Vectors of an estimate are in its order.
  const ParameterTable& parameters() const;
  /// Returns the configured axes with the remaining fractions of their delays.
  const std::vector<SensorAxis>& axes() const;
  /// Returns the parameters that the filters are tuned to now, theta order, SI: the design at
  /// first, then docs/equations.md (23).
  const Eigen::VectorXd& theta0() const;
  /// Returns the noise density of each axis, m/s^2/sqrt(Hz), configured or measured. Returns an
  /// empty vector while it is not known.
  std::vector<double> noise_density() const;
  /// Returns the length of the main window, in instants.
  int window_rows() const;
  /// Returns the lengths of the other windows (EstimatorOptions::other_windows_s), in instants,
  /// rounded to whole blocks.
  std::vector<int> other_window_rows() const;
  /// Returns the instants from one published window to the next.
  int hop_rows() const;
  /// Returns the counters up to now.
  PipelineCounters counters() const;

  /// Saves everything that later results depend on to `state`.
  void save(StateWriter& state);
  /// Loads what save() of a pipeline with the same configuration wrote. This pipeline then
  /// continues as that one would, to the bit. Returns false if the bytes do not fit; do not use
  /// the pipeline then.
  [[nodiscard]] bool load(StateReader& state);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Calls `take` with every estimate of the main window.
template <typename Take>
void each_main_window(Pipeline::Results&& results, const Take& take) {
  for (const PipelineResult& result : results)
    if (result.estimate != nullptr) take(*result.estimate);
}

/// Calls `take` with every estimate of the main window and of the other windows, not of late ones.
template <typename Take>
void each_window(Pipeline::Results&& results, const Take& take) {
  for (const PipelineResult& result : results)
    for (const WindowEstimate* estimate : {result.estimate, result.other})
      if (estimate != nullptr) take(*estimate);
}

}  // namespace framewatch::estimator
