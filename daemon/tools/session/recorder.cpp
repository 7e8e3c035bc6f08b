// SPDX-License-Identifier: MIT
#include "daemon/tools/session/recorder.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <framewatch/session_status_t.hpp>

#include <fmt/core.h>

#include "daemon/base/log.h"
#include "daemon/base/printable.h"
#include "daemon/base/process.h"
#include "daemon/monitor/estimation/estimation.h"
#include "daemon/monitor/estimation/publisher.h"
#include "daemon/monitor/live/live_intake.h"
#include "drivers/can/can_log.h"
#include "drivers/files/text_output.h"

namespace framewatch::daemon {
namespace {

constexpr double kCheck_s = 3, kMaxBefore_s = 62;  // the longest pre-trigger and its slack
constexpr std::size_t kMaxBeforeBytes = std::size_t{64} << 20;
constexpr std::int64_t kAfter_us = 500'000;  // for the estimates of the last samples to arrive
constexpr std::int64_t kSilence_us =
    10'000'000;  // from the length's end of a session without samples
constexpr std::int64_t kTroubleEvery_us = 10'000'000;
constexpr std::size_t kMaxVerb = 40;  // bytes shown of an unknown verb
constexpr double kSlack_s = 0.1;
constexpr double kTapOverRest = 8, kMinTap_mps2 = 0.05;

bool has_lcm_axes(const Config& config) {
  return std::any_of(config.sources.begin(), config.sources.end(),
                     [](const AxisSource& s) { return s.can.empty(); });
}

}  // namespace

Recorder::Recorder(const Config& config, std::string sessions, Ended ended)
    : config_(config),
      sessions_(std::move(sessions)),
      ended_(std::move(ended)),
      acquisition_(config.pipeline.axes, config.pipeline.options, true),
      intake_(
          wanted_axes(config), [this](const estimator::AccelSample& s) { sample(s); },
          intake_settings(config)),
      can_(config.can, [this](const estimator::AccelSample& s) { sample(s); }),
      rest_(config.pipeline.axes.size(), config.pipeline.options.rate_hz),
      check_(acquisition_.axes(), config.pipeline.options.rate_hz),
      taps_(config.pipeline.axes.size(), config.pipeline.options.rate_hz),
      trigger_axes_(estimator::shaken_axes(config.pipeline.axes)),
      before_(kMaxBefore_s, kMaxBeforeBytes),
      polarity_(config.pipeline.axes.size(), 0) {}

std::vector<std::string> Recorder::channels() const {
  std::vector<std::string> out = heard_channels(config_);
  for (const char* name : {"PARAMETERS", "STATUS", "EVENT", "GAP", "MODEL_FIT", "CAN"})
    out.push_back(config_.lcm.prefix + name);
  for (std::string& channel : estimate_channels(config_)) out.push_back(std::move(channel));
  return out;
}

void Recorder::message(const std::string& channel, const void* data, std::size_t size,
                       std::int64_t received_us, const drivers::LcmSender& sender) {
  now_us_ = received_us;
  const bool estimate = channel.starts_with(config_.lcm.prefix);
  store({estimate ? MessageKind::estimate : MessageKind::raw, received_us, channel,
         std::string(static_cast<const char*>(data), size)});
  if (!estimate)
    (void)intake_.message(channel, data, size, sender, received_us);
  else if (channel == config_.lcm.prefix + "ESTIMATE" && log_)
    ++session_.estimates;
}

void Recorder::frame(int bus, const drivers::CanFrame& frame) {
  now_us_ = frame.stamp_us;
  const std::string& interface = config_.can.buses[static_cast<std::size_t>(bus)].interface;
  store({MessageKind::frame, frame.stamp_us, interface,
         drivers::candump_line(frame, interface) + "\n"});
  can_.frame(bus, frame);
}

void Recorder::store(KeptMessage message) {
  if (log_) log_->write(message);
  if (message.kind != MessageKind::frame && (message.channel.ends_with("_CHANNELS") ||
                                             message.channel == config_.lcm.prefix + "PARAMETERS"))
    tables_[message.channel] = message;
  if (!log_) before_.push(std::move(message));
}

void Recorder::sample(const estimator::AccelSample& sample) {
  for (const estimator::SampleSet& set : acquisition_.push(sample)) keep(set);
}

void Recorder::keep(const estimator::SampleSet& set) {
  newest_us_ = to_microseconds(set.time);
  const std::vector<double>& distance = rest_.push(set);
  check_.push(set);
  if (state_ == RecorderState::tapping) detect_tap(distance);
  if (state_ == RecorderState::armed) detect_trigger(distance);
  if (state_ == RecorderState::recording) {
    if (session_.trigger_us == 0) session_.trigger_us = newest_us_;
    const double length_s = session_.request.length_s;
    if (length_s > 0 && close_at_us_ == 0 &&
        newest_us_ >= session_.trigger_us + static_cast<std::int64_t>(1e6 * length_s))
      (void)stop("length", now_us_);
  } else if (check_.seconds() >= kCheck_s) {
    const std::vector<estimator::AxisCounters> counters = acquisition_.counters();
    check_results_ = check_.results(counters);
    check_.begin(counters);
  }
}

void Recorder::detect_tap(const std::vector<double>& distance) {
  std::vector<double> threshold;
  for (const ChannelResult& r : check_results_)
    threshold.push_back(std::max(kTapOverRest * r.rms, kMinTap_mps2));
  threshold.resize(distance.size(), kMinTap_mps2);
  const auto tap = taps_.push(distance, threshold);
  if (!tap) return;
  if (tap->axis < 0) {
    news_ = "several sensors felt this tap alike: tap next to one sensor";
    return;
  }
  const auto axis = static_cast<std::size_t>(tap->axis);
  polarity_[axis] = tap->sign;
  const auto left = std::count(polarity_.begin(), polarity_.end(), 0);
  news_ = fmt::format("{}: {}, {:.2f} m/s^2; {} not tapped yet", config_.pipeline.axes[axis].name,
                      tap->sign > 0 ? "positive, correct" : "NEGATIVE: reversed", tap->peak, left);
  if (left == 0) state_ = RecorderState::waiting;
}

void Recorder::detect_trigger(const std::vector<double>& distance) {
  for (const std::size_t a : trigger_axes_) {
    if (!(std::abs(distance[a]) > session_.request.trigger_mps2)) continue;
    const std::string problem = open(now_us_, config_.pipeline.axes[a].name);
    if (!problem.empty()) {
      state_ = RecorderState::waiting;
      news_ = problem;
      log(LogLevel::error, problem);
    }
    return;
  }
}

std::string Recorder::begin(const SessionRequest& request, std::int64_t now_us,
                            const std::string& user) {
  if (state_ == RecorderState::recording) return "a session is being recorded: stop it first";
  for (const std::string& problem : problems(request)) return problem;
  session_ = {};
  session_.request = request;
  session_.asked_by = user;
  if (request.trigger_mps2 <= 0) return open(now_us, "");
  state_ = RecorderState::armed;
  news_.clear();
  return "";
}

std::string Recorder::tap() {
  if (state_ != RecorderState::waiting) return "a session is armed or being recorded";
  state_ = RecorderState::tapping;
  polarity_.assign(polarity_.size(), 0);
  taps_ = TapTest(polarity_.size(), config_.pipeline.options.rate_hz);
  news_ = "tap each sensor's place in the building's positive direction";
  return "";
}

std::string Recorder::stop(const std::string& why, std::int64_t now_us) {
  if (state_ == RecorderState::waiting) return "nothing is armed or recorded";
  if (state_ != RecorderState::recording) {
    state_ = RecorderState::waiting;
    news_.clear();
    return "";
  }
  if (close_at_us_ != 0) return "";
  session_.ended_by = why;
  session_.end_us = newest_us_;
  close_at_us_ = now_us + kAfter_us;
  return "";
}

void Recorder::obey(const session_command_t& c, const std::string& user, std::int64_t now_us) {
  if (c.id == answered_) return;
  answered_ = c.id;
  const SessionRequest request{c.test,     c.operator_name, c.notes,
                               c.length_s, c.trigger_mps2,  c.pre_trigger_s};
  if (c.verb == "tap")
    refused_ = tap();
  else if (c.verb == "stop")
    refused_ = stop("command", now_us);
  else if (c.verb == "arm" && !(c.trigger_mps2 > 0))
    refused_ = "arm needs a trigger level";
  else if (c.verb == "start" && c.trigger_mps2 > 0)
    refused_ = "start takes no trigger level: use arm";
  else if (c.verb == "arm" || c.verb == "start")
    refused_ = begin(request, now_us, user);
  else
    refused_ = "no such command: " + printable(c.verb, kMaxVerb);
  if (refused_.empty()) log(LogLevel::notice, fmt::format("{}, by {}", c.verb, user));
}

void Recorder::finished(const std::string& report, const std::string& news) {
  if (!report.empty()) report_ = report;
  if (state_ == RecorderState::waiting) news_ = news;
}

std::string Recorder::open(std::int64_t now_us, const std::string& triggered_by) {
  const std::string name = session_folder_name(now_us, session_.request.test);
  std::error_code error;
  std::filesystem::create_directories(sessions_, error);
  std::string folder = name;
  for (int i = 2; !error && !std::filesystem::create_directory(sessions_ + "/" + folder, error);
       ++i)
    folder = fmt::format("{}-{}", name, i);
  if (error) return fmt::format("{}/{}: {}", sessions_, folder, error.message());
  auto files = std::make_unique<SessionLog>();
  std::string problem;
  if (!files->open(sessions_ + "/" + folder, has_lcm_axes(config_), !config_.can.empty(), problem))
    return problem;
  folder_ = folder;
  // The trigger is found in a closed instant, up to lateness_s after its samples arrived.
  const double back_s =
      session_.request.pre_trigger_s + config_.pipeline.options.lateness_s + kSlack_s;
  const std::int64_t from_us = now_us - static_cast<std::int64_t>(1e6 * back_s);
  const bool before = !triggered_by.empty();
  // Tables that name samples and parameters come first.
  for (auto& [channel, table] : tables_) {
    KeptMessage first = table;
    first.received_us = before ? from_us : now_us;
    files->write(first);
  }
  if (before)
    for (const KeptMessage& m : before_.messages()) {
      if (m.received_us < from_us) continue;
      files->write(m);
      session_.estimates += m.channel == config_.lcm.prefix + "ESTIMATE";
    }
  before_.clear();
  log_ = std::move(files);
  session_.state = "recording";
  session_.config_path = config_.path;
  session_.config_sha256 = config_.sha256;
  session_.version = FRAMEWATCH_VERSION;
  session_.began_us = now_us;
  session_.trigger_us = newest_us_;
  session_.triggered_by = triggered_by;
  session_.check = channel_results();
  state_ = RecorderState::recording;
  close_at_us_ = trouble_said_us_ = 0;
  disk_failing_ = false;
  lost_before_ = lost();
  check_.begin(acquisition_.counters());
  news_ = before ? fmt::format("triggered by {}", triggered_by) : "";
  write_session_file();
  return "";
}

void Recorder::write_session_file() {
  const std::string problem = drivers::write_text_file(
      sessions_ + "/" + folder_ + "/" + kSessionJson, session_json(session_));
  if (problem.empty()) return;
  log(LogLevel::error, problem);
  news_ = problem;
}

void Recorder::close() {
  session_.run = channel_results();
  session_.messages = log_->messages();
  session_.lost = lost() - lost_before_;
  session_.dropped = log_->dropped();
  session_.state = "recorded";
  log_->close(session_.files, session_.problems);
  log_.reset();
  for (const std::string& problem : session_.problems) log(LogLevel::error, problem);
  state_ = RecorderState::waiting;
  close_at_us_ = 0;
  news_ = session_.problems.empty() ? "" : session_.problems.front();
  check_.begin(acquisition_.counters());
  write_session_file();
  ended_(sessions_ + "/" + folder_);
}

void Recorder::tick(std::int64_t now_us) {
  now_us_ = now_us;
  if (state_ != RecorderState::recording) return;
  const double length_s = session_.request.length_s;
  if (length_s > 0 && close_at_us_ == 0 &&
      now_us > session_.began_us + static_cast<std::int64_t>(1e6 * length_s) + kSilence_us)
    (void)stop("no samples", now_us);
  check_disk(now_us);
  if (close_at_us_ != 0 && now_us >= close_at_us_) close();
}

/// Returns the messages and CAN frames lost, by their sequence numbers.
std::int64_t Recorder::lost() const {
  std::int64_t sum = intake_.lost();
  for (std::size_t n = 0; n < config_.can.nodes.size(); ++n) sum += can_.node(n).lost;
  return sum;
}

void Recorder::check_disk(std::int64_t now_us) {
  const std::string why = log_->trouble();
  if (why.empty() && disk_failing_) {
    disk_failing_ = false;
    news_ = fmt::format("the recording is written to disk again; {} messages were dropped",
                        log_->dropped());
  } else if (!why.empty() && now_us >= trouble_said_us_) {
    disk_failing_ = true;
    trouble_said_us_ = now_us + kTroubleEvery_us;
    news_ = "cannot write the recording: " + why;
    log(LogLevel::error, news_);
  }
}

std::vector<ChannelResult> Recorder::channel_results() const {
  std::vector<ChannelResult> out =
      state_ == RecorderState::recording ? check_.results(acquisition_.counters()) : check_results_;
  for (std::size_t a = 0; a < out.size(); ++a) {
    out[a].polarity = polarity_[a];
    if (polarity_[a] < 0 && out[a].problem.empty())
      out[a].problem = "reversed: change its polarity in the configuration";
  }
  return out;
}

session_status_t Recorder::status(std::int64_t now_us) const {
  session_status_t s{};
  s.time_us = now_us;
  s.state = static_cast<std::int32_t>(state_);
  s.test = session_.request.test;
  s.session = folder_;
  s.report = report_;
  s.message = news_;
  s.answered = answered_;
  s.refused = refused_;
  const bool recording = state_ == RecorderState::recording;
  if (recording && session_.trigger_us != 0)
    s.elapsed_s = 1e-6 * static_cast<double>(newest_us_ - session_.trigger_us);
  s.length_s = session_.request.length_s;
  s.trigger_mps2 = session_.request.trigger_mps2;
  s.messages = log_ ? log_->messages() : session_.messages;
  s.estimates = session_.estimates;
  s.lost = log_ ? lost() - lost_before_ : session_.lost;
  s.dropped = log_ ? log_->dropped() : session_.dropped;
  s.bytes = log_ ? log_->bytes() : 0;
  s.disk_free_bytes = disk_free_bytes(sessions_);
  for (const ChannelResult& r : channel_results()) {
    s.name.push_back(r.name);
    s.noise_mps2_per_rthz.push_back(r.noise_density);
    s.rms_mps2.push_back(r.rms);
    s.offset_mps2.push_back(r.offset);
    s.peak_mps2.push_back(r.peak);
    s.range_mps2.push_back(r.range);
    s.saturated.push_back(r.saturated);
    s.polarity.push_back(r.polarity);
    s.problem.push_back(r.problem);
  }
  s.channels = static_cast<std::int32_t>(s.name.size());
  return s;
}

}  // namespace framewatch::daemon
