#include "daemon/estimation/estimation.h"

#include <utility>

#include "daemon/estimation/estimation_events.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {

Estimation::Estimation(const Config& config, MessageSink sink, Observer observer)
    : config_(config),
      observer_(std::move(observer)),
      publisher_(config, std::move(sink)),
      pipeline_(
          config.pipeline,
          [this](const estimator::WindowEstimate& estimate) { main_window(estimate); },
          [this](const estimator::WindowEstimate& estimate) {
            publisher_.other(estimate);
            watch(estimate);
          },
          [this](const estimator::SampleSet& instant) { look_for_gap(instant); }),
      intake_(wanted_axes(config), [this](const estimator::AccelSample& s) { sample(s); }),
      can_(config.can, [this](const estimator::AccelSample& s) { sample(s); }),
      can_events_(config.can) {
  can_.on_notice([this](const drivers::CanNotice& n) { notice(n); });
  begin_watch();
  begin_gap();
}

void Estimation::begin_watch() {
  watch_.reset();
  if (!config_.watch) return;
  watch_.emplace(pipeline_.parameters(), config_.watch->options,
                 window_lengths_s(config_.pipeline.options), config_.watch->baseline);
}

void Estimation::begin_gap() {
  gap_.reset();
  if (!config_.gap) return;
  gap_.emplace(config_.pipeline.structure, pipeline_.axes(), config_.pipeline.options,
               config_.gap->options, config_.gap->model);
}

void Estimation::main_window(const estimator::WindowEstimate& estimate) {
  if (observer_) observer_(estimate);
  publisher_.estimate(estimate);
  ++windows_;
  watch(estimate);
  if (gap_) gap_->learn(estimate, pipeline_.theta0());
}

void Estimation::look_for_gap(const estimator::SampleSet& instant) {
  if (!gap_) return;
  const estimator::GapWindow* window = gap_->push(instant, noise_density_);
  if (window == nullptr) return;
  publisher_.gap(*window);
  const estimator::GapNews* news = gap_->news();
  if (news == nullptr) return;
  announce(gap_event(*news, config_));
  if (taps_.gap) taps_.gap(*news);
}

void Estimation::adopt(const estimator::GapModel& model) {
  if (gap_) gap_->adopt(model);
}

void Estimation::watch(const estimator::WindowEstimate& estimate) {
  if (!watch_) return;
  for (const estimator::Alarm& alarm : watch_->push(estimate))
    announce(stiffness_event(alarm, pipeline_.parameters()));
}

drivers::IntakeResult Estimation::message(const std::string& channel, const void* data,
                                          std::size_t size) {
  if (config_.watch && channel == config_.watch->temperature_channel)
    return temperature(data, size);
  return intake_.message(channel, data, size);
}

drivers::IntakeResult Estimation::temperature(const void* data, std::size_t size) {
  const auto message =
      drivers::decoded<temperature_t>({static_cast<const std::uint8_t*>(data), size});
  if (!message) return drivers::IntakeResult::malformed;
  if (watch_)
    watch_->temperature(estimator::from_microseconds(message->time_us), message->temperature_degc);
  if (taps_.temperature) taps_.temperature(*message);
  return drivers::IntakeResult::table;
}

void Estimation::notice(const drivers::CanNotice& notice) {
  if (const auto event = can_events_.of(notice)) announce(*event);
}

void Estimation::announce(const event_t& event) {
  raised_.note(event);
  publisher_.event(event);
  if (taps_.event) taps_.event(event);
}

void Estimation::withdraw(const std::string& kind) {
  for (const event_t& event : raised_.take(kind)) announce(withdrawn(event));
}

void Estimation::sample(const estimator::AccelSample& sample) {
  if (seconds_.passed(to_microseconds(sample.time))) publish_state();
  if (taps_.sample) taps_.sample(sample);
  pipeline_.push(sample);
}

void Estimation::finish() {
  can_.finish();
  pipeline_.finish();
  publish_state();
}

void Estimation::save(estimator::StateWriter& state) {
  state(seconds_, windows_, intake_, can_, can_events_, raised_);
  if (watch_) state(*watch_);
  if (gap_) state(*gap_, noise_density_);
  pipeline_.save(state);
}

bool Estimation::load(estimator::StateReader& state) {
  state(seconds_, windows_, intake_, can_, can_events_, raised_);
  if (watch_) state(*watch_);
  if (gap_) state(*gap_, noise_density_);
  return state.good() && pipeline_.load(state);
}

void Estimation::take_over(Estimation& before, bool keep_window) {
  // Both have the same structure, so only settings can keep a part from fitting.
  const auto copy = [](auto& from, auto& to) {
    estimator::StateWriter writer;
    writer(from);
    estimator::StateReader reader(writer.bytes());
    reader(to);
    return reader.whole();
  };
  copy(before.seconds_, seconds_);
  copy(before.intake_, intake_);
  copy(before.can_, can_);
  copy(before.can_events_, can_events_);
  copy(before.raised_, raised_);
  windows_ = before.windows_;
  live_ = before.live_;
  if (keep_window) {
    estimator::StateWriter writer;
    before.pipeline_.save(writer);
    estimator::StateReader reader(writer.bytes());
    (void)pipeline_.load(reader);
    noise_density_ = before.noise_density_;
  }
  const estimator::Baseline* given = baseline();
  const bool same_baseline =
      given == nullptr || (before.baseline() != nullptr && before.baseline()->holds(*given));
  const bool watch_goes_on =
      watch_ && before.watch_ && same_baseline && copy(*before.watch_, *watch_);
  if (!watch_goes_on) {
    begin_watch();
    withdraw("stiffness_change");
  } else if (!keep_window && config_.watch->options.amplitude) {
    watch_->forget_quiet();  // amplitudes are over the noise, which is another one
  }
  const bool gap_goes_on = gap_ && before.gap_ && copy(*before.gap_, *gap_);
  if (!gap_goes_on) {
    begin_gap();
    withdraw("gap");
  }
}

void Estimation::publish_state() {
  const estimator::PipelineCounters pipeline = pipeline_.counters();
  const drivers::IntakeCounters& intake = intake_.counters();
  StatusCounts counts;
  counts.windows = pipeline.windows;
  counts.sample_sets = pipeline.sample_sets;
  counts.gaps = pipeline.interruptions;
  counts.rejected_messages = intake.foreign + intake.malformed + intake.duplicate;
  for (std::size_t n = 0; n < can_.map().nodes.size(); ++n) {
    const drivers::CanNodeCounters node = can_.node(n);
    counts.rejected_messages +=
        node.wrong_length + node.wrong_kind + node.unplaced + node.duplicates + node.late;
  }
  noise_density_ = pipeline_.noise_density();
  for (std::size_t i = 0; i < pipeline.axes.size(); ++i) {
    const estimator::AxisCounters& axis = pipeline.axes[i];
    const drivers::SequenceCounter* node = intake_.sequence_of(i);
    counts.axes.push_back({axis.received, node == nullptr ? can_.lost_of(i) : node->lost, axis.late,
                           axis.repaired, axis.rejected + (node == nullptr ? 0 : node->duplicates),
                           axis.stuck, axis.clipped});
    if (!noise_density_.empty()) counts.axes.back().noise_density = noise_density_[i];
  }
  publisher_.parameters(seconds_.newest_us(), pipeline_);
  publisher_.status(seconds_.newest_us(), counts, live_);
  if (watch_) publisher_.watch(seconds_.newest_us(), *watch_);
}

}  // namespace framewatch::daemon
