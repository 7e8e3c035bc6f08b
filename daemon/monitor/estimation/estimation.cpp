// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimation/estimation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <framewatch/temperature_t.hpp>

#include "daemon/base/usual_time.h"
#include "daemon/config/config_size.h"
#include "daemon/monitor/estimation/estimation_events.h"
#include "daemon/monitor/events/change_words.h"
#include "daemon/monitor/events/event_messages.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"
#include "estimator/identify/groups/layout_prediction.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxFindings = 50;
constexpr double kMost_degc = 200;  // absolute value; no thermometer on a building shows more

EstimationListener no_listener;  // does nothing

void subtract(const estimator::AxisCounters& before, estimator::AxisCounters& from) {
  from.received -= before.received, from.missing -= before.missing, from.late -= before.late;
  from.repaired -= before.repaired, from.stuck -= before.stuck, from.clipped -= before.clipped;
  from.rejected -= before.rejected, from.absurd -= before.absurd;
}

}  // namespace

bool SensorSeconds::passed(std::int64_t time_us) {
  std::int64_t step = 0;
  const bool near = started_ && !__builtin_sub_overflow(time_us, newest_us_, &step) &&
                    step <= kLargestStep_us && step >= -kLargestStep_us;
  if (!started_ || (!near && ++strays_ >= kStraysToFollow)) {
    started_ = true;
    strays_ = 0;
    newest_us_ = time_us;
    next_us_ = time_us > INT64_MAX - kSecond_us ? INT64_MAX : time_us + kSecond_us;
    return true;
  }
  if (!near) return false;
  strays_ = 0;
  if (step <= 0) return false;
  newest_us_ = time_us;
  if (newest_us_ < next_us_) return false;
  while (next_us_ <= newest_us_ && next_us_ <= INT64_MAX - kSecond_us) next_us_ += kSecond_us;
  return true;
}

std::vector<drivers::WantedAxis> wanted_axes(const Config& config) {
  std::vector<drivers::WantedAxis> wanted;
  for (std::size_t i = 0; i < config.pipeline.axes.size(); ++i) {
    const AxisSource source = i < config.sources.size() ? config.sources[i] : AxisSource{};
    wanted.push_back({config.pipeline.axes[i].name, source.lcm_channel, source.sensor_node,
                      source.axis, source.can.empty()});
  }
  return wanted;
}

drivers::IntakeSettings intake_settings(const Config& config) {
  return {config.pipeline.options.rate_hz, config.lcm.two_senders};
}

estimator::PipelineConfig with_design_error(estimator::PipelineConfig config) {
  if (!config.parameters().grouped()) return config;
  estimator::LayoutPrediction foreseen =
      predict_layout(config, estimator::noise_densities(config.axes), {},
                     {config.profile_tolerance, config.mass_tolerance});
  config.design_error = std::move(foreseen.design_error);
  config.change_error = std::move(foreseen.change_error);
  config.change_leak = std::move(foreseen.change_leak);
  return config;
}

Estimation::Estimation(const Config& config, MessageSink sink, EstimationListener* listener)
    : config_(config),
      listener_(listener != nullptr ? listener : &no_listener),
      publisher_(config, std::move(sink)),
      foreseen_(with_design_error(config.pipeline)),
      pipeline_(foreseen_),
      strong_(pipeline_.axes(), config.pipeline.options.rate_hz),
      intake_(
          wanted_axes(config), [this](const estimator::AccelSample& s) { sample(s); },
          intake_settings(config)),
      can_(config.can, [this](const estimator::AccelSample& s) { sample(s); }),
      can_events_(config.can),
      channel_events_(config.pipeline.axes, config.pipeline.options.lateness_s),
      stamp_events_(config.pipeline.axes, config.pipeline.options),
      newest_us_(config.pipeline.axes.size(), INT64_MIN),
      weather_(config) {
  intake_.on_notice([this](const drivers::IntakeNotice& n) { intake_notice(n); });
  can_.on_notice([this](const drivers::CanNotice& n) { notice(n); });
  can_.on_value([this](std::size_t covariate, double value, std::int64_t) {
    weather_value(covariate, value);
  });
  begin_watch();
  begin_gap();
  if (!config.event_report) return;
  estimator::PipelineConfig with_axes = config.pipeline;
  with_axes.axes = pipeline_.axes();
  shaking_.emplace(with_axes, config.event_report->options);
  counted_before_.resize(config.pipeline.axes.size());
}

void Estimation::begin_watch() {
  watch_.reset();
  recovery_.reset();
  if (!config_.watch) return;
  watch_.emplace(pipeline_.parameters(), config_.watch->options,
                 window_lengths_s(config_.pipeline.options), config_.watch->baseline,
                 estimator::ChangeModel{foreseen_.change_error, foreseen_.change_leak});
  recovery_.emplace(*watch_, config_.watch->options);
}

/// The gap monitor also checks the channels, so [watch] needs it as well.
void Estimation::begin_gap() {
  gap_.reset();
  const bool simulated = simulated_size_problem(config_.pipeline.structure).empty();
  if (!config_.gap && !(config_.watch && simulated)) return;
  GapSettings settings = config_.gap.value_or(GapSettings{});
  if (!config_.gap)
    settings.options.learn_s = std::min(settings.options.learn_s, config_.watch->options.learn_s);
  gap_.emplace(config_.pipeline, pipeline_.axes(), settings.options, settings.model);
}

void Estimation::follow_shaking(const estimator::SampleSet& instant) {
  if (!shaking_) return;
  const bool ended = shaking_->push(instant, baseline());
  if (shaking_->began()) {
    counted_before_ = axis_counters();
    findings_.clear();
  }
  if (!ended) return;
  EventReport report{shaking_->ended(), axis_counters(), findings_};
  report.shaking.known.noise_density = pipeline_.noise_density();
  add_records(report);
  for (std::size_t a = 0; a < report.axes.size(); ++a) subtract(counted_before_[a], report.axes[a]);
  announce(event_of(report, config_));
  listener_->on_shaken(report);
}

/// Adds the findings of [watch] and the open alarms to the report.
void Estimation::add_records(EventReport& report) const {
  for (const event_t& e : raised_.all())
    if (e.severity == severity::alarm && e.kind != "stiffness_change" && e.kind != "strong_motion")
      report.open.push_back(e);
  if (!watch_) return;
  for (std::size_t p = 0; p < report.shaking.stiffness.size(); ++p) {
    estimator::ShakenStiffness& s = report.shaking.stiffness[p];
    s.watched = watch_->baseline() != nullptr && watch_->baseline()->knows(p) && watch_->watched(p);
    if (const auto* r = watch_->record(static_cast<int>(p))) s.record = *r;
  }
  if (const auto* r = watch_->record(estimator::ChangeRecord::kEverything)) report.everything = *r;
}

void Estimation::take(estimator::Pipeline::Results&& results) {
  for (const estimator::PipelineResult& result : results) {
    if (result.instant != nullptr) {
      compare_gap(*result.instant);
      if (watch_) strong_.push(*result.trusted);
      follow_shaking(*result.trusted);
      listener_->on_instant(*result.instant);
    }
    if (result.estimate != nullptr) {
      listener_->on_estimate(*result.estimate);
      publisher_.estimate(*result.estimate);
      ++windows_;
      watch(*result.estimate);
      if (gap_) gap_->learn(*result.estimate, pipeline_.theta0());
      if (shaking_) shaking_->push(*result.estimate);
    }
    if (result.other != nullptr) {
      publisher_.other(*result.other);
      watch(*result.other);
    }
    if (result.model != nullptr) publisher_.model(*result.model);
    if (result.late != nullptr) {  // the gap monitor learns only from the newest windows
      publisher_.late(*result.late);
      if (shaking_) shaking_->push(*result.late);
    }
  }
}

void Estimation::compare_gap(const estimator::SampleSet& instant) {
  if (!gap_) return;
  const estimator::GapWindow* window = gap_->push(instant, noise_density_);
  for (const estimator::ChannelNews& news : gap_->channel_news())
    announce(doubt_event(news, config_.pipeline.axes));
  if (!gap_->channel_news().empty()) pipeline_.leave_out(gap_->doubted());
  if (window == nullptr || !config_.gap) return;
  publisher_.gap(*window);
  if (shaking_) shaking_->push_gap(window->nrmse);
  const estimator::GapNews* news = gap_->news();
  if (news == nullptr) return;
  announce(gap_event(*news, config_));
  listener_->on_gap(*news);
}

/// Returns false while a channel seems to misread, and while a building in groups of stories is
/// seen by other channels than those that its baseline was learned with.
bool Estimation::speaks_of_building() const {
  if (!gap_) return true;
  const auto& doubted = gap_->doubted();
  const bool without = std::find(doubted.begin(), doubted.end(), 1) != doubted.end();
  return !gap_->has_candidate() && !(without && pipeline_.parameters().grouped());
}

void Estimation::watch(const estimator::WindowEstimate& estimate) {
  if (!watch_ || !speaks_of_building()) return;
  for (const estimator::Alarm& alarm : watch_->push(estimate))
    announce(with_recovery(
        stiffness_event(alarm, pipeline_.parameters(), frame_labels(config_.pipeline.structure)),
        alarm.parameter));
  follow_recovery(estimate);
}

drivers::IntakeResult Estimation::message(const std::string& channel, const void* data,
                                          std::size_t size, const drivers::LcmSender& sender,
                                          std::int64_t received_us) {
  const std::span<const std::uint8_t> bytes(static_cast<const std::uint8_t*>(data), size);
  const bool of_watch = config_.watch && channel == config_.watch->temperature_channel;
  if (of_watch || weather_.hears_thermometer(channel)) return temperature(channel, bytes);
  if (weather_.hears(channel)) return weather(channel, bytes);
  arrival_us_ = received_us;
  const drivers::IntakeResult result = intake_.message(channel, data, size, sender, received_us);
  arrival_us_ = 0;
  return result;
}

void Estimation::frame(int bus, const drivers::CanFrame& frame) {
  arrival_us_ = frame.stamp_us;
  can_.frame(bus, frame);
  arrival_us_ = 0;
}

drivers::IntakeResult Estimation::temperature(const std::string& channel,
                                              std::span<const std::uint8_t> bytes) {
  const auto message = drivers::decoded<temperature_t>(bytes);
  if (!message) return drivers::IntakeResult::malformed;
  weather_.thermometer(channel, message->time_us, message->temperature_degc, seconds_.newest_us());
  if (!(std::abs(message->temperature_degc) <= kMost_degc)) {
    ++absurd_temperatures_;
    return drivers::IntakeResult::malformed;
  }
  if (watch_ && channel == config_.watch->temperature_channel)
    watch_->temperature(estimator::from_microseconds(message->time_us), message->temperature_degc);
  listener_->on_weather(channel, message->time_us, {bytes.begin(), bytes.end()});
  return drivers::IntakeResult::table;
}

drivers::IntakeResult Estimation::weather(const std::string& channel,
                                          std::span<const std::uint8_t> bytes) {
  const auto message = drivers::decoded<weather_t>(bytes);
  if (!message) return drivers::IntakeResult::malformed;
  if (!weather_.take(channel, *message, seconds_.newest_us()))
    return drivers::IntakeResult::foreign;
  listener_->on_weather(channel, message->time_us, {bytes.begin(), bytes.end()});
  return drivers::IntakeResult::table;
}

void Estimation::weather_value(std::size_t covariate, double value,
                               std::optional<std::int64_t> time_us) {
  const weather_t reading = weather_.value(covariate, value, time_us, seconds_.newest_us());
  if (!reading.name.empty())
    listener_->on_weather(config_.weather[covariate].lcm_channel, reading.time_us,
                          drivers::encoded(reading));
}

void Estimation::notice(const drivers::CanNotice& notice) {
  if (const auto event = can_events_.of(notice)) announce(*event);
}

void Estimation::intake_notice(const drivers::IntakeNotice& notice) {
  const std::int64_t now_us = seconds_.newest_us() != 0 ? seconds_.newest_us() : notice.arrival_us;
  if (const auto event = intake_event(notice, config_, raised_, now_us)) announce(*event);
}

void Estimation::announce(const event_t& event) {
  raised_.note(event);
  if (shaking_ && shaking_->active() && findings_.size() < kMaxFindings) findings_.push_back(event);
  publisher_.event(event);
  listener_->on_event(event);
}

void Estimation::withdraw(const std::string& kind) {
  for (const event_t& event : raised_.take(kind)) announce(withdrawn(event));
}

void Estimation::sample(const estimator::AccelSample& sample) {
  if (seconds_.passed(to_microseconds(sample.time))) publish_state();
  listener_->on_sample(sample);
  channel_events_.sample(sample);
  stamp_events_.sample(sample);
  if (const auto axis = static_cast<std::size_t>(sample.axis); axis < newest_us_.size())
    newest_us_[axis] = to_microseconds(sample.time);
  take(pipeline_.push(sample));
}

void Estimation::came_up(bool raw) {
  intake_.came_up();
  if (!shaking_) return;
  shaking_->came_up(estimator::from_microseconds(usual_time_us(newest_us_, INT64_MIN)), raw);
}

void Estimation::finish() {
  can_.finish();
  take(pipeline_.finish());
  publish_state();
}

std::vector<estimator::AxisCounters> Estimation::axis_counters() const {
  std::vector<estimator::AxisCounters> out = pipeline_.counters().axes;
  for (std::size_t a = 0; a < out.size(); ++a) {
    out[a].rejected += can_.absurd_of(a);
    out[a].absurd += can_.absurd_of(a);
  }
  return out;
}

void Estimation::publish_state() {
  for (const event_t& event : std::exchange(to_withdraw_, {})) announce(withdrawn(event));
  const std::vector<estimator::AxisCounters> axes = axis_counters();
  for (const event_t& event : channel_events_.update(axes, seconds_.newest_us())) announce(event);
  std::vector<std::int64_t> lost;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const drivers::HeardNode* node = intake_.node_of(i);
    lost.push_back(node == nullptr ? can_.lost_of(i) : node->counter.lost);
  }
  for (const event_t& event : stamp_events_.update(lost, seconds_.newest_us())) announce(event);
  if (const auto event = clock_events_.update(seconds_.newest_us(), arrival_us_)) announce(*event);
  for (const event_t& event : weather_.update(seconds_.newest_us())) announce(event);
  for (event_t event : std::vector<event_t>(raised_.all())) {
    if (!green_and_past(event, seconds_.newest_us())) continue;
    event.state = event_state::cleared;
    event.time_us = seconds_.newest_us();
    announce(event);
  }
  const estimator::PipelineCounters pipeline = pipeline_.counters();
  const drivers::IntakeCounters& intake = intake_.counters();
  status_t status{};
  status.time_us = seconds_.newest_us();
  status.windows = pipeline.windows;
  status.sample_sets = pipeline.sample_sets;
  status.gaps = pipeline.interruptions;
  status.queue_high_water = live_.queue_high_water;
  status.queue_dropped = live_.queue_dropped;
  status.latency_s = live_.latency_s;
  status.rejected_messages = intake.foreign + intake.malformed + intake.duplicate +
                             intake.other_sender + absurd_temperatures_;
  for (std::size_t n = 0; n < can_.map().nodes.size(); ++n) {
    const drivers::CanNodeCounters node = can_.node(n);
    status.rejected_messages +=
        node.wrong_length + node.wrong_kind + node.unplaced + node.duplicates + node.late;
  }
  noise_density_ = pipeline_.noise_density();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const estimator::AxisCounters& axis = axes[i];
    const drivers::HeardNode* node = intake_.node_of(i);
    status.received.push_back(axis.received);
    status.lost.push_back(lost[i]);
    status.late.push_back(axis.late);
    status.repaired.push_back(axis.repaired);
    status.rejected.push_back(axis.rejected + (node == nullptr ? 0 : node->left_out()));
    status.stuck.push_back(axis.stuck);
    status.clipped.push_back(axis.clipped);
    status.noise_mps2_per_rthz.push_back(noise_density_.empty() ? estimator::kNaN
                                                                : noise_density_[i]);
  }
  publisher_.parameters(seconds_.newest_us(), pipeline_);
  publisher_.status(std::move(status));
  if (watch_) publisher_.watch(seconds_.newest_us(), *watch_);
  if (weather_.any()) publisher_.weather(weather_.status(seconds_.newest_us()));
}

void Estimation::follow_recovery(const estimator::WindowEstimate& estimate) {
  const bool of_weak_motion = static_cast<std::size_t>(estimate.window) ==
                              window_lengths_s(config_.pipeline.options).size();
  recovery_->push(estimate, of_weak_motion, *watch_, strong_);
  const estimator::ParameterTable table = pipeline_.parameters();
  for (const int p : recovery_->due()) {
    const event_t* const raised = raised_.find("stiffness_change", table[p].name);
    if (raised != nullptr && is_recovering(*raised, p))
      announce(with_recovery(renewed(*raised, estimate.end), p));
  }
}

bool Estimation::is_recovering(const event_t& event, int parameter) const {
  const estimator::Recovery* recovery = recovery_->of(parameter);
  return recovery != nullptr && recovery->is_of(estimator::from_microseconds(event.since_us));
}

event_t Estimation::with_recovery(event_t event, int parameter) const {
  if (!is_recovering(event, parameter)) return event;
  return recovering(std::move(event), recovery_->of(parameter)->law());
}

}  // namespace framewatch::daemon
