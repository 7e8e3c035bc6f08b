// SPDX-License-Identifier: MIT
#include "estimator/pipeline/pipeline.h"

#include <utility>

#include "estimator/identify/window/sliding_window_estimator.h"
#include "estimator/motion/acquisition.h"
#include "estimator/numeric/nan.h"

namespace framewatch::estimator {

class Pipeline::Implementation {
 public:
  explicit Implementation(const PipelineConfig& config)
      : table_(config.parameters()),
        acquisition_(config.axes, config.options),
        estimator_(config, table_),
        left_out_(config.axes.size()) {
    trusted_.accel.resize(config.axes.size());
  }

  void start_tuned(const Tuning& tuning) { estimator_.start_tuned(tuning); }
  Acquisition& acquisition() { return acquisition_; }
  void leave_out(const std::vector<std::uint8_t>& left_out) {
    for (std::size_t a = 0; a < left_out_.size(); ++a) wrong_ |= left_out[a] > left_out_[a];
    left_out_ = left_out;
  }

  /// Returns the next result, valid until the next call, or null.
  const PipelineResult* next() {
    for (;;) {
      result_ = {};
      if (looking_back_) {
        result_.late = estimator_.late();
        if (result_.late != nullptr) return &result_;
        looking_back_ = false;
      }
      if (std::exchange(wrong_, false)) estimator_.forget_motion();
      if (missing_ > 0) {
        --missing_;
        estimator_.push_missing();
      } else if (instant_ != nullptr) {
        result_.estimate = estimator_.push(*std::exchange(instant_, nullptr));
        if (result_.estimate != nullptr) ++windows_;
      } else {
        instant_ = acquisition_.next();
        if (instant_ == nullptr) return nullptr;
        ++sets_;
        missing_ = estimator_.missing_before(*instant_);
        result_.instant = instant_;
        trusted_.copy(*instant_);
        for (std::size_t a = 0; a < left_out_.size(); ++a)
          if (left_out_[a] != 0) trusted_.accel[a] = kNaN;
        instant_ = result_.trusted = &trusted_;
        return &result_;
      }
      result_.other = estimator_.other();
      result_.model = estimator_.model_fit();
      looking_back_ = true;
      if (result_.estimate != nullptr || result_.other != nullptr || result_.model != nullptr)
        return &result_;
    }
  }

  PipelineCounters counters() const {
    return {sets_, estimator_.interruptions(), windows_, estimator_.retunes(),
            acquisition_.counters()};
  }

  template <typename Archive>
  void archive(Archive& a) {
    a(acquisition_, estimator_);
    for (std::int64_t* count : {&sets_, &windows_}) a.within(*count, 0, a.kMaxCount);
    if (a.since(18)) {
      a.each_within(left_out_, 0, 1);
      a(wrong_);
    }
  }

  const ParameterTable& table() const { return table_; }
  const std::vector<SensorAxis>& axes() const { return acquisition_.axes(); }
  const SlidingWindowEstimator& estimator() const { return estimator_; }

 private:
  ParameterTable table_;
  Acquisition acquisition_;
  SlidingWindowEstimator estimator_;
  PipelineResult result_;
  const SampleSet* instant_ = nullptr;  ///< for the estimator
  SampleSet trusted_;
  std::vector<std::uint8_t> left_out_;
  bool wrong_ = false;         ///< samples in the windows are wrong
  int missing_ = 0;            ///< instants without samples before it
  bool looking_back_ = false;  ///< late windows are asked for
  std::int64_t sets_ = 0, windows_ = 0;
};

Pipeline::Pipeline(const PipelineConfig& config)
    : implementation_(std::make_unique<Implementation>(config)) {}
Pipeline::~Pipeline() = default;
void Pipeline::start_tuned(const Tuning& tuning) {
  implementation_->start_tuned(tuning);
}
std::optional<Tuning> Pipeline::tuning() const {
  return implementation_->estimator().tuning();
}
Pipeline::Results Pipeline::push(const AccelSample& sample) {
  implementation_->acquisition().take(sample);
  return Results(*this);
}
Pipeline::Results Pipeline::finish() {
  implementation_->acquisition().end();
  return Results(*this);
}
void Pipeline::leave_out(const std::vector<std::uint8_t>& left_out) {
  implementation_->leave_out(left_out);
}
const PipelineResult* Pipeline::next() {
  return implementation_->next();
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
