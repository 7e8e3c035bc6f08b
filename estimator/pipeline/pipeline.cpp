#include "estimator/pipeline/pipeline.h"

#include <algorithm>
#include <cmath>

#include "estimator/identify/window/sliding_window_estimator.h"
#include "estimator/motion/acquisition.h"

namespace framewatch::estimator {

class Pipeline::Implementation {
 public:
  Implementation(const PipelineConfig& config, Sink sink, Sink others, InstantSink instants,
                 ModelSink models)
      : table_(config.parameters()),
        acquisition_(config.axes, config.options, [this](const SampleSet& set) { estimate(set); }),
        estimator_(config, table_),
        sink_(std::move(sink)),
        others_(std::move(others)),
        instants_(std::move(instants)),
        models_(std::move(models)) {}

  void start_tuned(const Tuning& tuning) { estimator_.start_tuned(tuning); }
  void push(const AccelSample& raw) { acquisition_.push(raw); }
  void finish() { acquisition_.finish(); }

  PipelineCounters counters() const {
    return {sets_, estimator_.interruptions(), windows_, estimator_.retunes(),
            acquisition_.counters()};
  }

  void on_late(Sink late) { late_ = std::move(late); }

  template <typename Archive>
  void archive(Archive& a) {
    a(acquisition_, estimator_);
    for (std::int64_t* count : {&sets_, &windows_}) a.within(*count, 0, a.kMaxCount);
  }

  const ParameterTable& table() const { return table_; }
  const std::vector<SensorAxis>& axes() const { return acquisition_.axes(); }
  const SlidingWindowEstimator& estimator() const { return estimator_; }

 private:
  void estimate(const SampleSet& set) {
    ++sets_;
    if (instants_) instants_(set);
    for (int missing = estimator_.missing_before(set); missing > 0; --missing) {
      estimator_.push_missing();
      give_others();
    }
    if (const WindowEstimate* estimate = estimator_.push(set)) {
      ++windows_;
      sink_(*estimate);
    }
    give_others();
  }

  void give_others() {
    if (const WindowEstimate* other = estimator_.other(); other != nullptr && others_)
      others_(*other);
    if (const ModelFit* fit = estimator_.model_fit(); fit != nullptr && models_) models_(*fit);
    while (const WindowEstimate* late = estimator_.late())
      if (late_) late_(*late);
  }

  ParameterTable table_;
  Acquisition acquisition_;
  SlidingWindowEstimator estimator_;
  Sink sink_, others_, late_;
  InstantSink instants_;
  ModelSink models_;
  std::int64_t sets_ = 0, windows_ = 0;
};

Pipeline::Pipeline(const PipelineConfig& config, Sink sink, Sink others, InstantSink instants,
                   ModelSink models)
    : implementation_(std::make_unique<Implementation>(config, std::move(sink), std::move(others),
                                                       std::move(instants), std::move(models))) {}
Pipeline::~Pipeline() = default;
void Pipeline::on_late(Sink late) {
  implementation_->on_late(std::move(late));
}
void Pipeline::start_tuned(const Tuning& tuning) {
  implementation_->start_tuned(tuning);
}
std::optional<Tuning> Pipeline::tuning() const {
  return implementation_->estimator().tuning();
}
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
const Eigen::VectorXd& Pipeline::theta0() const {
  return implementation_->estimator().theta0();
}
std::vector<double> Pipeline::noise_density() const {
  const SlidingWindowEstimator& estimator = implementation_->estimator();
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

}  // namespace framewatch::estimator
