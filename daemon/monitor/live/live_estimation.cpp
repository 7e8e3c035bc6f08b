// SPDX-License-Identifier: MIT
#include "daemon/monitor/live/live_estimation.h"

#include "daemon/base/clocks.h"
#include "daemon/monitor/actions/acknowledge.h"

namespace framewatch::daemon {
namespace {

std::vector<std::string> with(std::vector<std::string> channels, const std::string& another) {
  channels.push_back(another);
  return channels;
}

}  // namespace

LiveEstimation::LiveEstimation(const Config& config, drivers::LcmProvider& lcm,
                               drivers::CanLogWriter* can_log)
    : config_(std::make_unique<const Config>(config)),
      can_map_(config.can),
      lcm_(lcm),
      can_log_(can_log),
      request_channel_(acknowledge_channel(config)),
      intake_(
          lcm, with(heard_channels(config), request_channel_), config.lcm.queue_capacity,
          [this](const drivers::LcmMessage& message) { on_message(message); }, can_map_,
          can_log != nullptr,
          [this](int bus, const drivers::CanFrame& frame) { on_frame(bus, frame); }) {
  times_.newest_us.resize(config.pipeline.axes.size());
  begin_estimation();
}

void LiveEstimation::begin_estimation() {
  estimation_ = std::make_unique<Estimation>(
      *config_,
      [this](std::int64_t, const std::string& channel, const std::vector<std::uint8_t>& bytes) {
        lcm_.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
        if (history_ != nullptr) history_->message(channel, bytes);
      },
      this);
  if (!segments_ && config_->gap && !config_->gap->store.empty()) segments_.emplace(*config_);
}

void LiveEstimation::reconfigure(Config next, Reach reach) {
  segments_.reset();  // writes pending samples under the old settings
  // The old estimation refers to its configuration, so both live until the new one has taken over.
  const std::unique_ptr<const Config> config_before =
      std::exchange(config_, std::make_unique<const Config>(std::move(next)));
  const std::unique_ptr<Estimation> before = std::move(estimation_);
  begin_estimation();
  estimation_->take_over(*before, reach == Reach::settings);
}

void LiveEstimation::connect_mqtt() {
  if (config_->mqtt && !mqtt_topics(*config_).empty())
    mqtt_ = std::make_unique<MqttIntake>(*config_);
}

void LiveEstimation::catch_up(RawBacklog backlog) {
  backlog_ = std::move(backlog);
  if (backlog_.empty()) estimation_->came_up(backlog_.read_whole());
}

/// Passes waiting data to the estimation, the backlog first.
void LiveEstimation::feed() {
  const std::int64_t until_us = steady_clock_us() + 1000 * kFeed_ms;
  const auto enough = [until_us] { return steady_clock_us() >= until_us; };
  feeding_ = true;
  if (!backlog_.empty()) {
    backlog_.give([this](const estimator::AccelSample& s) { estimation_->sample(s); },
                  [this](const drivers::LogEvent& event) {
                    estimation_->message(event.channel, event.data.data(), event.data.size());
                  },
                  enough);
    if (backlog_.empty()) estimation_->came_up(backlog_.read_whole());
  }
  feeding_ = false;
  for (; backlog_.empty() && !later_.empty() && !enough(); later_.pop_front()) {
    const Later& l = later_.front();
    if (l.channel.empty())
      estimate_frame(l.bus, l.frame);
    else
      estimate_message({l.channel, l.data.data(), l.data.size(), l.received_us, l.sender});
  }
}

void LiveEstimation::keep(Later later) {
  if (later_.size() == kMaxLater)
    ++state_.queue_dropped;
  else
    later_.push_back(std::move(later));
}

void LiveEstimation::on_sample(const estimator::AccelSample& sample) {
  if (feeding_) return;
  times_.received_us = host_clock_us();
  times_.newest_us[static_cast<std::size_t>(sample.axis)] = to_microseconds(sample.time);
  if (segments_) segments_->sample(sample);
  if (history_ != nullptr) history_->sample(sample);
}

void LiveEstimation::on_weather(const std::string& channel, std::int64_t time_us,
                                const std::vector<std::uint8_t>& bytes) {
  if (history_ != nullptr && !feeding_) history_->weather(channel, time_us, bytes);
}

void LiveEstimation::on_event(const event_t& event) {
  if (events_.size() == kMaxEvents)
    ++state_.queue_dropped;
  else
    events_.push_back(event);
}

void LiveEstimation::on_gap(const estimator::GapNews& news) {
  if (segments_ && news.state == estimator::AlarmState::raised) segments_->raised(news.id);
}

void LiveEstimation::step_done(std::int64_t began_us, std::int64_t windows_before,
                               std::int64_t received_us) {
  times_.steps.add(1e-6 * static_cast<double>(steady_clock_us() - began_us));
  if (estimation_->windows() == windows_before) return;
  state_.latency_s = 1e-6 * static_cast<double>(host_clock_us() - received_us);
  times_.latencies.add(state_.latency_s);
  if (state_.latency_s > config_->pipeline.options.hop_s) ++times_.deadline_missed;
}

bool LiveEstimation::poll(int timeout_ms) {
  if (catching_up()) {
    feed();
    if (catching_up()) timeout_ms = 0;
  }
  const bool good = intake_.poll(timeout_ms);
  for (std::size_t b = 0; b < config_->can.buses.size(); ++b) {
    const bool gone = !can().state(static_cast<int>(b)).open;
    estimation_->notice(
        {drivers::CanNotice::Kind::interface_gone, static_cast<int>(b), !gone, 0, host_clock_us()});
  }
  if (mqtt_ != nullptr && !catching_up()) mqtt_->poll(*estimation_, host_clock_us());
  const std::int64_t dropped = intake_.lcm().dropped().queue_full;
  state_.queue_dropped += dropped - std::exchange(lcm_dropped_, dropped);
  state_.queue_high_water = static_cast<std::int32_t>(intake_.lcm().backlog_high_water());
  return good && !can_log_failed_;
}

void LiveEstimation::on_frame(int bus, const drivers::CanFrame& frame) {
  const std::string& interface = config_->can.buses[static_cast<std::size_t>(bus)].interface;
  if (can_log_ != nullptr && !can_log_->write(frame, interface)) can_log_failed_ = true;
  if (catching_up()) return keep({.bus = bus, .frame = frame});
  estimate_frame(bus, frame);
}

void LiveEstimation::estimate_frame(int bus, const drivers::CanFrame& frame) {
  const std::int64_t began_us = steady_clock_us(), windows = estimation_->windows();
  estimation_->frame(bus, frame);
  const std::int64_t dropped = can().dropped();
  state_.queue_dropped += dropped - std::exchange(can_dropped_, dropped);
  step_done(began_us, windows, frame.stamp_us);
  estimation_->set_live(state_);
}

void LiveEstimation::on_message(const drivers::LcmMessage& message) {
  const auto* bytes = static_cast<const std::uint8_t*>(message.data);
  if (message.channel == request_channel_) {
    if (requests_.size() < AcknowledgeDesk::kMaxRequests)
      requests_.emplace_back(bytes, bytes + message.size);
    return;
  }
  if (!catching_up()) return estimate_message(message);
  keep({.channel = message.channel,
        .data = {bytes, bytes + message.size},
        .sender = message.sender,
        .received_us = message.received_us});
}

void LiveEstimation::estimate_message(const drivers::LcmMessage& message) {
  const std::int64_t began_us = steady_clock_us(), windows = estimation_->windows();
  estimation_->message(message.channel, message.data, message.size, message.sender,
                       message.received_us);
  step_done(began_us, windows, message.received_us);
  estimation_->set_live(state_);
}

}  // namespace framewatch::daemon
