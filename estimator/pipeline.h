#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/estimate.h"
#include "estimator/motion/sample.h"
#include "estimator/motion/sample_merger.h"
#include "estimator/options.h"
#include "estimator/state/archive.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"

namespace framewatch {

struct PipelineCounters {
  std::int64_t sample_sets = 0;
  std::int64_t gaps = 0;     ///< breaks that restarted the window
  std::int64_t windows = 0;  ///< estimates given to the sink
  std::int64_t retunes = 0;  ///< times the filters were re-tuned
  std::vector<AxisCounters> axes;
};

/// Everything the estimating process needs to know, validated by problems().
struct PipelineConfig {
  Structure structure;
  std::vector<SensorAxis> axes;
  EstimatorOptions options;
  /// Design parameters, theta order, SI; empty when the drawings say nothing.
  Eigen::VectorXd design;
};

std::vector<std::string> problems(const PipelineConfig& config);

/// Samples in, window estimates out. Never asks the time, never throws and never allocates after
/// construction. Work that takes long is spread over instants by their count (docs/performance.md).
class Pipeline {
 public:
  using Sink = std::function<void(const WindowEstimate&)>;
  using InstantSink = std::function<void(const SampleSet&)>;

  /// Precondition: problems(config) is empty. others: gets the estimates of the other windows, if
  /// anybody wants them; instants: the calibrated instants, each before the estimate it completes.
  Pipeline(const PipelineConfig& config, Sink sink, Sink others = {}, InstantSink instants = {});
  ~Pipeline();

  /// One axis at one instant. Any order within options.lateness_s.
  void push(const AccelSample& sample);
  /// The input has ended: closes the instants still open.
  void finish();

  const ParameterTable& parameters() const;
  /// The configured axes with what is left of their delays in calibrated instants.
  const std::vector<SensorAxis>& axes() const;
  /// Design the filters are tuned to now, theta order.
  const Eigen::VectorXd& design() const;
  /// Noise the channels' rows are weighted by now, m/s^2/sqrt(Hz), configured or measured; empty
  /// while it is not known.
  std::vector<double> noise_density() const;
  int window_rows() const;
  /// Of EstimatorOptions::other_windows_s, rounded to whole blocks.
  std::vector<int> other_window_rows() const;
  int hop_rows() const;
  PipelineCounters counters() const;

  /// Everything that what is still to come depends on. A pipeline of the same configuration that
  /// load()s it goes on as this one would, bit by bit; after a load() that is false it must not be
  /// used any more.
  void save(StateWriter& state);
  [[nodiscard]] bool load(StateReader& state);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace framewatch
