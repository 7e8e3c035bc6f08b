#include "estimator/pipeline.h"

#include <algorithm>
#include <cmath>

#include "estimator/identify/window_estimator.h"
#include "estimator/motion/acquisition.h"

namespace framewatch {

std::vector<std::string> problems(const PipelineConfig& config) {
  std::vector<std::string> found = problems(config.structure);
  if (!found.empty()) return found;
  found = problems(config.structure, config.axes);
  const EstimatorOptions& o = config.options;
  const auto at_least = [&](const char* name, double value, double least) {
    if (!(std::isfinite(value) && value >= least))
      found.push_back(std::string(name) + ": must be at least " + std::to_string(least));
  };
  at_least("rate_hz", o.rate_hz, 1);
  at_least("window_s", o.window_s, 40 / o.rate_hz);
  for (const double s : o.other_windows_s) {
    at_least("other_windows_s", s, 8 / o.rate_hz);
    if (s > 20 * o.window_s) found.push_back("other_windows_s: at most 20 times window_s");
  }
  if (o.long_window_s != 0) {
    double longest = o.window_s;
    for (const double s : o.other_windows_s) longest = std::max(longest, s);
    if (!(o.long_window_s > longest))
      found.push_back("the long window (watch.quiet_window_s): must be longer than the others");
  }
  at_least("hop_s", o.hop_s, 0);
  at_least("boxplot_windows", o.boxplot_windows, 1);
  at_least("high_pass_hz", o.high_pass_hz, 0.001);
  at_least("filter_damping", o.filter_damping, 0.05);
  at_least("corner_ratio", o.corner_ratio, 0.1);
  if (config.design.size() > 0) {
    const ParameterTable table(config.structure);
    if (config.design.size() != table.size() || !(config.design.array() > 0).all())
      found.push_back("design: needs " + std::to_string(table.size()) + " values > 0");
  }
  return found;
}

class Pipeline::Implementation {
 public:
  Implementation(const PipelineConfig& config, Sink sink, Sink others, InstantSink instants)
      : table_(config.structure),
        acquisition_(config.axes, config.options, [this](const SampleSet& set) { estimate(set); }),
        estimator_(config, table_),
        sink_(std::move(sink)),
        others_(std::move(others)),
        instants_(std::move(instants)) {}

  void push(const AccelSample& raw) { acquisition_.push(raw); }
  void finish() { acquisition_.finish(); }

  PipelineCounters counters() const {
    return {sets_, estimator_.gaps(), windows_, estimator_.retunes(), acquisition_.counters()};
  }

  template <typename Archive>
  void archive(Archive& a) {
    a(acquisition_, estimator_, sets_, windows_);
  }

  const ParameterTable& table() const { return table_; }
  const std::vector<SensorAxis>& axes() const { return acquisition_.axes(); }
  const WindowEstimator& estimator() const { return estimator_; }

 private:
  void estimate(const SampleSet& set) {
    ++sets_;
    if (instants_) instants_(set);
    if (const WindowEstimate* estimate = estimator_.push(set)) {
      ++windows_;
      sink_(*estimate);
    }
    if (const WindowEstimate* other = estimator_.other(); other != nullptr && others_)
      others_(*other);
  }

  ParameterTable table_;
  Acquisition acquisition_;
  WindowEstimator estimator_;
  Sink sink_, others_;
  InstantSink instants_;
  std::int64_t sets_ = 0, windows_ = 0;
};

Pipeline::Pipeline(const PipelineConfig& config, Sink sink, Sink others, InstantSink instants)
    : implementation_(std::make_unique<Implementation>(config, std::move(sink), std::move(others),
                                                       std::move(instants))) {}
Pipeline::~Pipeline() = default;
void Pipeline::push(const AccelSample& sample) {
  implementation_->push(sample);
}
void Pipeline::finish() {
  implementation_->finish();
}
const ParameterTable& Pipeline::parameters() const {
  return implementation_->table();
}
const std::vector<SensorAxis>& Pipeline::axes() const {
  return implementation_->axes();
}
const Eigen::VectorXd& Pipeline::design() const {
  return implementation_->estimator().design();
}
std::vector<double> Pipeline::noise_density() const {
  const WindowEstimator& estimator = implementation_->estimator();
  return estimator.noise_known() ? estimator.noise_density() : std::vector<double>{};
}
int Pipeline::window_rows() const {
  return implementation_->estimator().window_rows();
}
std::vector<int> Pipeline::other_window_rows() const {
  return implementation_->estimator().other_window_rows();
}
int Pipeline::hop_rows() const {
  return implementation_->estimator().hop_rows();
}
PipelineCounters Pipeline::counters() const {
  return implementation_->counters();
}
void Pipeline::save(StateWriter& state) {
  implementation_->archive(state);
}
bool Pipeline::load(StateReader& state) {
  implementation_->archive(state);
  return state.good();
}

}  // namespace framewatch
