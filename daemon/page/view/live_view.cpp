// SPDX-License-Identifier: MIT
#include "daemon/page/view/live_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <framewatch/event_t.hpp>

#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/monitor/live/live_intake.h"
#include "daemon/page/view/page_json.h"
#include "daemon/page/view/page_modes.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/accel_codec.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
namespace {

constexpr std::size_t kRing = 256;  // 10 s of events
constexpr int kFlushesPerBoxplot = 5;
constexpr int kFlushesPerSecond = 20;
constexpr std::int64_t kYear2000_us = 946'684'800'000'000;

}  // namespace

LiveView::LiveView(const Config& config, MessageSink publish, PageCommands::Give give)
    : config_(config),
      publish_(std::move(publish)),
      estimate_channels_(estimate_channels(config)),
      latest_(config.lcm.prefix),
      motion_(config.pipeline.options.rate_hz),
      acquisition_(config.pipeline.axes, config.pipeline.options),
      intake_(
          wanted_axes(config), [this](const estimator::AccelSample& s) { sample(s); },
          intake_settings(config)),
      shaking_(config.pipeline),
      grouped_(config.pipeline.parameters().grouped()),
      mode_errors_(config.pipeline.options.window_s),
      reports_(config.event_report ? config.event_report->directory : std::string()),
      ring_(kRing),
      history_(config.pipeline),
      commands_(std::move(give), [this](const PageCommand& command, const std::string& problem) {
        push("refused", refused_json(command.id, problem));
      }) {
  estimate_channels_.resize(1 + config.pipeline.options.other_windows_s.size());
}

void LiveView::restore(const StoredHistory& stored, std::int64_t now_us) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    history_.restore(stored.estimates);
    alarms_.restore(stored.events);
  }
  if (stored.samples.empty()) return;
  constexpr std::int64_t kFlush_us = 1'000'000 / kFlushesPerSecond;
  const std::int64_t last_us = to_microseconds(stored.samples.back().time);
  std::int64_t flush =
      std::numeric_limits<std::int64_t>::min();  // before the first one, which is 1
  for (const estimator::AccelSample& sample : stored.samples) {
    this->sample(sample);
    const std::int64_t at = (to_microseconds(sample.time) - last_us) / kFlush_us;
    if (at <= flush) continue;
    flush = at;
    if (const std::string rows = motion_.take(); !rows.empty()) {
      const std::lock_guard<std::mutex> lock(mutex_);
      history_.motion(rows, flush, kFlushesPerSecond);
    }
  }
  // The age of the samples is unknown when their clock does not count from 1970.
  motion_at_ =
      last_us > kYear2000_us ? -std::max<std::int64_t>(0, now_us - last_us) / kFlush_us : 0;
}

std::vector<std::string> LiveView::channels() const {
  std::vector<std::string> out = sample_channels(config_);
  for (std::string& channel :
       latest_.channels({DaemonMessage::parameters, DaemonMessage::status, DaemonMessage::event,
                         DaemonMessage::gap, DaemonMessage::model_fit, DaemonMessage::can,
                         DaemonMessage::session, DaemonMessage::service,
                         DaemonMessage::acknowledged, DaemonMessage::watch}))
    out.push_back(std::move(channel));
  out.insert(out.end(), estimate_channels_.begin(), estimate_channels_.end());
  out.push_back(estimate_channels_.front() + kLate);
  return out;
}

void LiveView::sample(const estimator::AccelSample& sample) {
  for (const estimator::SampleSet& set : acquisition_.push(sample)) instant(set);
}

void LiveView::push(const std::string& name, const std::string& data) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ring_.push(name, data);
}

/// The caller holds the mutex.
void LiveView::push_alarms(const std::vector<std::string>& alarms) {
  for (const std::string& alarm : alarms) ring_.push("alarm", alarm);
}

/// Pushes an event and keeps it for viewers that join later.
void LiveView::keep(const std::string& name, std::string json) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ring_.push(name, json);
  kept_[name] = std::move(json);
}

void LiveView::message(const std::string& channel, const void* data, std::size_t size,
                       const drivers::LcmSender& sender, std::int64_t received_us) {
  if (!channel.starts_with(config_.lcm.prefix)) {
    (void)intake_.message(channel, data, size, sender, received_us);
    return;
  }
  const std::span payload(static_cast<const std::uint8_t*>(data), size);
  if (const auto changed = latest_.update(channel, payload))
    show(*changed);
  else
    other_estimate(channel, payload);
}

void LiveView::show(DaemonMessage changed) {
  switch (changed) {
    case DaemonMessage::parameters:
      return parameters(*latest_.parameters);
    case DaemonMessage::estimate:
      return estimate(0, *latest_.estimate);
    case DaemonMessage::status:
      same_config_ = latest_.status->config_sha256 == config_.sha256;
      return keep("status", status_json(*latest_.status, config_.sha256));
    case DaemonMessage::session:
      return keep("session", session_status_json(*latest_.session));
    case DaemonMessage::can:
      return keep("can", can_json(*latest_.can));
    case DaemonMessage::gap:
      return keep("gap", gap_json(*latest_.gap));
    case DaemonMessage::model_fit:
      if (static_cast<std::size_t>(latest_.model_fit->parameters) == parameters_.size())
        keep("fit", model_fit_json(*latest_.model_fit));
      return;
    default:
      return show_alarms(changed);
  }
}

bool LiveView::found_here(const event_t& event) const {
  return !config_.watch && event.kind == "stiffness_change";
}

void LiveView::show_alarms(DaemonMessage changed) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (changed == DaemonMessage::event) {
    const event_t& e = *latest_.event;
    push_alarms({found_here(e) ? alarms_.note_own(e) : alarms_.note(e)});
  } else if (changed == DaemonMessage::service) {
    push_alarms(alarms_.still_raised(*latest_.service));
  } else if (changed == DaemonMessage::acknowledged) {
    push_alarms(alarms_.acknowledged(*latest_.acknowledged));
  }
}

void LiveView::parameters(const parameter_table_t& table) {
  if (table.name == parameters_) return;
  parameters_ = table.name;
  watch_.reset();
  new_values_ = true;
  // Estimates for another building's configuration are shown but not watched.
  same_parameters_ = parameters_ == parameter_names(config_);
  if (same_parameters_) watch_.emplace(config_, std::max<std::int64_t>(1, table.time_us));
}

void LiveView::estimate(int window, const window_estimate_t& found) {
  // Rejects times that would overflow in later arithmetic.
  if (found.window_end_us > drivers::kLatestTime_us ||
      found.window_end_us < -drivers::kLatestTime_us)
    return;
  detect_changes(window, found);
  if (window != 0) return;
  new_estimate_ = new_values_ = true;
  estimate_at_ = flushes_;
  fit_.push(found);
  if (found.value.size() == parameters_.size() && same_parameters_)
    shaking_.follow(decoded_estimate(window, found));
  newest_ = found;
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_us_ = found.window_end_us;
  history_.estimate(found);
}

/// Takes the estimates of the other windows, and those of the main window that came late.
void LiveView::other_estimate(const std::string& channel, std::span<const std::uint8_t> payload) {
  const bool late = channel == estimate_channels_.front() + kLate;
  const auto at = std::find(estimate_channels_.begin() + 1, estimate_channels_.end(), channel);
  if (!late && at == estimate_channels_.end()) return;
  const auto found = drivers::decoded<window_estimate_t>(payload);
  if (!found) return;
  if (!late) return estimate(static_cast<int>(at - estimate_channels_.begin()), *found);
  const std::lock_guard<std::mutex> lock(mutex_);
  late_rows_ = history_.late(*found) || late_rows_;
}

void LiveView::detect_changes(int window, const window_estimate_t& estimate) {
  if (!watch_) return;
  bool renew = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::swap(renew, renew_);
  }
  if (renew) watch_->renew();
  for (const event_t& e : watch_->observe(window, estimate))
    if (!config_.watch)  // else the estimator publishes its own
      publish_(e.time_us, config_.lcm.prefix + "EVENT", drivers::encoded(e));
}

std::vector<double> LiveView::baseline() const {
  if (latest_.watch && latest_.watch->baseline.size() == parameters_.size())
    return latest_.watch->baseline;
  return watch_ && !config_.watch ? watch_->baseline() : std::vector<double>{};
}

bool LiveView::watched(std::size_t parameter) const {
  if (latest_.watch && parameter < latest_.watch->watched.size())
    return latest_.watch->watched[parameter] != 0;
  return watch_ && watch_->watched(parameter);
}

void LiveView::instant(const estimator::SampleSet& set) {
  motion_at_ = flushes_;
  shaking_.push(set);
  motion_.push(grouped_ ? with_every_floor(set, config_.pipeline.structure, shaking_.response())
                        : set);
  const std::lock_guard<std::mutex> lock(mutex_);
  history_.instant(set);
}

double LiveView::seconds_since(std::int64_t flush) const {
  return static_cast<double>(flushes_ - flush) / kFlushesPerSecond;
}

/// The caller holds the mutex.
Known LiveView::known() const {
  Known out;
  out.findings = alarms_.findings(config_);
  if (const auto misfit = fit_.finding()) out.findings.push_back(*misfit);
  const std::vector<double> baseline = this->baseline();
  for (std::size_t p = 0; p < parameters_.size(); ++p) {
    if (!watched(p)) continue;
    ++out.watched;
    out.with_baseline += p < baseline.size() && std::isfinite(baseline[p]) ? 1 : 0;
    out.observable += newest_ && p < newest_->reason.size() && newest_->reason[p] == 0 ? 1 : 0;
  }
  out.samples = shaking_.first_us() != 0;
  out.silent_s = seconds_since(motion_at_);
  out.estimates = newest_.has_value();
  out.estimates_silent_s = seconds_since(estimate_at_);
  out.same_config = same_config_;
  out.residual = fit_.residual();
  out.newest = shaking_.newest();
  out.drifts = shaking_.drifts();
  out.strongest = shaking_.strongest();
  out.followed_since_us = shaking_.first_us();
  out.report = reports_.newest();
  return out;
}

/// Does as keep() if the event differs from the previous one. The caller holds the mutex.
void LiveView::push_if_new(const std::string& name, const std::string& json) {
  if (json != kept_[name]) ring_.push(name, json);
  kept_[name] = json;
}

/// Pushes the modes of values that have come since the last call.
void LiveView::show_modes() {
  if (!std::exchange(new_values_, false)) return;
  NewestValues newest;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest = history_.newest();
  }
  PageModes modes;
  if (parameters_.empty() || same_parameters_)
    modes = page_modes(config_, newest);
  else
    modes.why = "the estimator has other parameters than this page";
  if (modes.why.empty()) mode_errors_.correct(modes);
  const std::string json = modes_json(modes);
  const std::lock_guard<std::mutex> lock(mutex_);
  push_if_new("modes", json);
}

LiveView::ReadingOutcome LiveView::reading(const std::string& name, double value,
                                           std::optional<std::int64_t> time_us) {
  const auto covariate = std::ranges::find(config_.weather, name, &WeatherSettings::name);
  if (covariate == config_.weather.end()) return ReadingOutcome::unknown_name;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!time_us) time_us = newest_us_;
  if (!time_us) return ReadingOutcome::no_time;
  if (readings_.size() >= kMostReadings) return ReadingOutcome::full;
  weather_t message{};
  message.time_us = *time_us;
  message.name = name;
  message.value = value;
  readings_.emplace_back(covariate->lcm_channel, message);
  return ReadingOutcome::taken;
}

void LiveView::send_readings() {
  std::vector<std::pair<std::string, weather_t>> readings;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    readings.swap(readings_);
  }
  for (const auto& [channel, message] : readings)
    publish_(message.time_us, channel, drivers::encoded(message));
}

void LiveView::flush() {
  ++flushes_;
  send_readings();
  if (const std::string rows = motion_.take(); !rows.empty()) {
    push("motion", rows);
    const std::lock_guard<std::mutex> lock(mutex_);
    history_.motion(rows, flushes_, kFlushesPerSecond);
  }
  if (flushes_ % kFlushesPerSecond == 0) {
    show_modes();
    const std::lock_guard<std::mutex> lock(mutex_);
    silent_s_ = seconds_since(motion_at_);
    (void)reports_.poll();
    push_if_new("baseline", baseline_json(baseline()));
    push_if_new("answers", answers_json(known(), config_));
    push_if_new("last", history_.last_json());
    if (std::exchange(late_rows_, false)) ring_.push("late", "{}");
    ring_.push("alive", "{}");
  }
  if (std::exchange(new_estimate_, false))
    push("estimate", estimate_json(*newest_, config_.pipeline.options.min_snr));
  if (flushes_ % kFlushesPerBoxplot != 0) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (const std::string boxes = history_.boxes_json(); !boxes.empty()) push_if_new("boxes", boxes);
}

std::string LiveView::history_json() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return history_.json(silent_s_);
}

std::string LiveView::building_json() const {
  return daemon::building_json(config_, config_.pipeline.options.rate_hz / motion_.stride());
}

EventRing::Cursor LiveView::join() {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::string first = "retry: 1000\n\n";
  for (const char* name :
       {"status", "baseline", "last", "boxes", "modes", "answers", "session", "can", "gap"})
    if (const std::string& json = kept_[name]; !json.empty()) first += EventRing::text(name, json);
  for (const std::string& alarm : alarms_.all()) first += EventRing::text("alarm", alarm);
  return ring_.join(std::move(first));
}

std::size_t LiveView::read(EventRing::Cursor& cursor, char* buffer, std::size_t size) {
  const std::lock_guard<std::mutex> lock(mutex_);
  return ring_.read(cursor, buffer, size);
}

std::optional<std::int64_t> LiveView::acknowledge(std::int64_t id, const std::string& viewer) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const event_t* event = alarms_.find(id);
  if (event == nullptr) return std::nullopt;
  if (!alarms_.kept_elsewhere() || found_here(*event)) {
    push_alarms({alarms_.acknowledge(id)});
    return 0;
  }
  const acknowledge_t request = acknowledge_request(id, viewer, "");
  if (!commands_.add({"run", {"ACKNOWLEDGE", drivers::encoded(request)}, request.request}))
    return std::nullopt;
  return request.request;
}

bool LiveView::renew_baseline() {
  if (config_.watch) return false;
  const std::lock_guard<std::mutex> lock(mutex_);
  renew_ = true;
  return true;
}

bool LiveView::tell_recorder(const session_command_t& command) {
  return commands_.add({"record", {"SESSION_COMMAND", drivers::encoded(command)}, command.id});
}

}  // namespace framewatch::daemon
