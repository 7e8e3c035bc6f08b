#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/estimate/estimate.h"
#include "estimator/motion/pulled.h"
#include "estimator/motion/sample.h"
#include "estimator/motion/sample_merger.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/state/archive.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

struct PipelineCounters {
  std::int64_t sample_sets = 0;
  std::int64_t interruptions = 0;  ///< breaks that restarted the window
  std::int64_t windows = 0;        ///< estimates of the main window
  std::int64_t retunes = 0;        ///< times the filters were re-tuned
  std::vector<AxisCounters> axes;
};

/// One result of a pipeline; pointers are null for what it does not have.
struct PipelineResult {
  /// A calibrated instant. It comes before the estimates that it completes.
  const SampleSet* instant = nullptr;
  /// Of the main window that ends now.
  const WindowEstimate* estimate = nullptr;
  /// Of a window of another length (EstimatorOptions::other_windows_s).
  const WindowEstimate* other = nullptr;
  /// How far the model may be wrong, once per window length.
  const ModelFit* model = nullptr;
  /// Of a window that was held back while the filters were not tuned to the building. Ends in the
  /// past.
  const WindowEstimate* late = nullptr;
};

/// Turns samples into window estimates. Reads no clock, never throws and allocates nothing after
/// construction. Long computations are spread over instants by their count (docs/performance.md).
class Pipeline {
 public:
  using Results = Pulled<Pipeline, PipelineResult>;

  /// Precondition: problems(config) is empty.
  explicit Pipeline(const PipelineConfig& config);
  ~Pipeline();

  /// The row filters are tuned to this from the first sample on, as after a pass over the same
  /// record. To be called before the first sample. Precondition: the tuning is of a pipeline with
  /// the same structure and axes. Of no effect where options.self_tune is false.
  void start_tuned(const Tuning& tuning);
  /// What the row filters are tuned to; empty while the noise of an axis is not known, and where
  /// options.self_tune is false.
  std::optional<Tuning> tuning() const;

  /// Takes a sample of one axis at one instant, in any order within options.lateness_s. Returns the
  /// results it completes, in their order; the caller may ignore them.
  Results push(const AccelSample& sample);
  /// Ends the input: closes the instants still open, and returns their results.
  Results finish();
  /// Returns the next result of the newest push() or finish(), valid until the next call, or null.
  const PipelineResult* next();

  const ParameterTable& parameters() const;
  /// The configured axes with the remaining fractions of their delays in calibrated instants.
  const std::vector<SensorAxis>& axes() const;
  /// The parameters that the filters are tuned to now, theta order, SI: the design at first, then
  /// docs/equations.md (23).
  const Eigen::VectorXd& theta0() const;
  /// Noise the channels' rows are weighted by now, m/s^2/sqrt(Hz), configured or measured; empty
  /// while it is not known.
  std::vector<double> noise_density() const;
  int window_rows() const;
  /// Of EstimatorOptions::other_windows_s, rounded to whole blocks.
  std::vector<int> other_window_rows() const;
  int hop_rows() const;
  PipelineCounters counters() const;

  /// Everything that later results depend on. A pipeline of the same configuration that load()s it
  /// continues as this one would, to the bit; after a load() that is false it must not be used any
  /// more.
  void save(StateWriter& state);
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
