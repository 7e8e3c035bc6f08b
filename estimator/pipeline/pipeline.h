#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/estimate/estimate.h"
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
  std::int64_t windows = 0;        ///< estimates given to the sink
  std::int64_t retunes = 0;        ///< times the filters were re-tuned
  std::vector<AxisCounters> axes;
};

/// Samples in, window estimates out. Reads no clock, never throws and allocates nothing after
/// construction. Long computations are spread over instants by their count (docs/performance.md).
class Pipeline {
 public:
  using Sink = std::function<void(const WindowEstimate&)>;
  using InstantSink = std::function<void(const SampleSet&)>;
  using ModelSink = std::function<void(const ModelFit&)>;

  /// Precondition: problems(config) is empty. others: gets the estimates of the other windows, if
  /// anybody wants them; instants: the calibrated instants, each before the estimate it completes;
  /// models: how far the model may be wrong, once per window's length.
  Pipeline(const PipelineConfig& config, Sink sink, Sink others = {}, InstantSink instants = {},
           ModelSink models = {});
  /// Gets windows that were held back while the filters were not tuned to the building (late).
  void on_late(Sink late);
  ~Pipeline();

  /// The row filters are tuned to this from the first sample on, as after a pass over the same
  /// record. To be called before the first sample. Precondition: the tuning is of a pipeline with
  /// the same structure and axes. Of no effect where options.self_tune is false.
  void start_tuned(const Tuning& tuning);
  /// What the row filters are tuned to; empty while the noise of an axis is not known, and where
  /// options.self_tune is false.
  std::optional<Tuning> tuning() const;

  /// One axis at one instant. Any order within options.lateness_s.
  void push(const AccelSample& sample);
  /// The input has ended: closes the instants still open.
  void finish();

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

}  // namespace framewatch::estimator
