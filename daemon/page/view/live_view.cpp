#include "daemon/page/view/live_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <framewatch/acknowledged_t.hpp>
#include <framewatch/can_status_t.hpp>
#include <framewatch/event_t.hpp>
#include <framewatch/gap_t.hpp>
#include <framewatch/service_t.hpp>
#include <framewatch/session_status_t.hpp>
#include <framewatch/status_t.hpp>

#include "daemon/monitor/estimation/estimate_channels.h"
#include "daemon/monitor/estimation/wanted_axes.h"
#include "daemon/monitor/events/acknowledge_messages.h"
#include "daemon/monitor/live/heard_channels.h"
#include "daemon/page/view/page_json.h"
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
      motion_(config.pipeline.options.rate_hz),
      acquisition_(config.pipeline.axes, config.pipeline.options),
      intake_(
          wanted_axes(config), [this](const estimator::AccelSample& s) { sample(s); },
          intake_settings(config)),
      shaking_(config.pipeline),
      grouped_(config.pipeline.parameters().grouped()),
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
  // A clock that does not count from 1970 does not say how long ago that was.
  motion_at_ =
      last_us > kYear2000_us ? -std::max<std::int64_t>(0, now_us - last_us) / kFlush_us : 0;
}

std::vector<std::string> LiveView::channels() const {
  std::vector<std::string> out = sample_channels(config_);
  for (const char* name : {"PARAMETERS", "STATUS", "EVENT", "GAP", "MODEL_FIT", "CAN", "SESSION",
                           "SERVICE", "ACKNOWLEDGED", "WATCH"})
    out.push_back(config_.lcm.prefix + name);
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

/// Pushes an event that a viewer who joins later gets at once.
void LiveView::keep(const std::string& name, std::string json) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ring_.push(name, json);
  kept_[name] = std::move(json);
}

void LiveView::message(const std::string& channel, const void* data, std::size_t size,
                       const drivers::LcmSender& sender, std::int64_t received_us) {
  const std::string& prefix = config_.lcm.prefix;
  if (!channel.starts_with(prefix)) {
    (void)intake_.message(channel, data, size, sender, received_us);
    return;
  }
  const std::string name = channel.substr(prefix.size());
  const std::span bytes(static_cast<const std::uint8_t*>(data), size);
  if (name == "PARAMETERS") {
    parameters(bytes);
  } else if (channel == estimate_channels_.front() + kLate) {
    late_estimate(bytes);
  } else if (name.starts_with("ESTIMATE")) {
    estimate(channel, bytes);
  } else if (name == "STATUS") {
    if (const auto s = drivers::decoded<status_t>(bytes)) {
      same_config_ = s->config_sha256 == config_.sha256;
      keep("status", status_json(*s, config_.sha256));
    }
  } else if (name == "WATCH") {
    if (auto w = drivers::decoded<watch_t>(bytes)) told_watch_ = std::move(*w);
  } else if (name == "SESSION") {
    if (const auto s = drivers::decoded<session_status_t>(bytes))
      keep("session", session_status_json(*s));
  } else if (name == "CAN") {
    if (const auto s = drivers::decoded<can_status_t>(bytes)) keep("can", can_json(*s));
  } else if (name == "GAP") {
    if (const auto gap = drivers::decoded<gap_t>(bytes)) keep("gap", gap_json(*gap));
  } else if (name == "MODEL_FIT") {
    const auto fit = drivers::decoded<model_fit_t>(bytes);
    if (fit && static_cast<std::size_t>(fit->parameters) == parameters_.size())
      keep("fit", model_fit_json(*fit));
  } else {
    alarms_message(name, bytes);
  }
}

bool LiveView::found_here(const event_t& event) const {
  return !config_.watch && event.kind == "stiffness_change";
}

void LiveView::alarms_message(const std::string& name, std::span<const std::uint8_t> bytes) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (name == "EVENT") {
    const auto e = drivers::decoded<event_t>(bytes);
    if (e) push_alarms({found_here(*e) ? alarms_.note_own(*e) : alarms_.note(*e)});
  } else if (name == "SERVICE") {
    if (const auto s = drivers::decoded<service_t>(bytes)) push_alarms(alarms_.still_raised(*s));
  } else if (name == "ACKNOWLEDGED") {
    if (auto a = drivers::decoded<acknowledged_t>(bytes))
      push_alarms(alarms_.acknowledged(std::move(*a)));
  }
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

/// An event that a viewer who joins later gets at once, if it differs from the one before. The
/// caller holds the mutex.
void LiveView::push_if_new(const std::string& name, const std::string& json) {
  if (json != kept_[name]) ring_.push(name, json);
  kept_[name] = json;
}

void LiveView::flush() {
  ++flushes_;
  if (const std::string rows = motion_.take(); !rows.empty()) {
    push("motion", rows);
    const std::lock_guard<std::mutex> lock(mutex_);
    history_.motion(rows, flushes_, kFlushesPerSecond);
  }
  if (flushes_ % kFlushesPerSecond == 0) {
    const std::lock_guard<std::mutex> lock(mutex_);
    silent_s_ = seconds_since(motion_at_);
    (void)reports_.look();
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
       {"status", "baseline", "last", "boxes", "answers", "session", "can", "gap"})
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
