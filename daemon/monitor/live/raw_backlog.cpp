// SPDX-License-Identifier: MIT
#include "daemon/monitor/live/raw_backlog.h"

#include <algorithm>

#include "daemon/base/usual_time.h"
#include "daemon/monitor/history/history_files.h"
#include "daemon/monitor/history/raw_history_reader.h"
#include "estimator/motion/acquisition.h"
#include "estimator/shaking/shaking_watch.h"

namespace framewatch::daemon {
namespace {

constexpr double kOtherClocks_s = 60;  // the stamps of two axes may differ by this

std::int64_t backlog_us(double seconds) {
  return static_cast<std::int64_t>(1e6 * seconds);
}

}  // namespace

RawBacklog RawBacklog::read(const Config& config, const std::vector<std::int64_t>& known_us,
                            bool resumed, std::vector<std::string>& notes) {
  RawBacklog out;
  if (!config.history || (!resumed && !config.event_report)) return out;
  const std::string& directory = config.history->directory;
  const std::vector<RawLog> logs = raw_logs(raw_folder(directory));
  if (logs.empty()) return out;
  const std::int64_t newest_us = usual_time_us(known_us, INT64_MIN);
  std::int64_t from_us = logs.back().start_us - backlog_us(kMost_s);
  if (newest_us != INT64_MIN) from_us = std::max(from_us, newest_us - backlog_us(kOtherClocks_s));
  const std::size_t most = kMaxSamples + static_cast<std::size_t>(config.pipeline.options.rate_hz *
                                                                  config.history->rotate_s) *
                                             config.pipeline.axes.size();
  std::vector<int> axis_of;
  const RawVisitor visitor{
      [&](const std::vector<std::string>& names, double) {
        axis_of = axes_of(names, config.pipeline.axes);
      },
      [&](const RawCount& c) {
        const int axis = axis_of[c.channel];
        if (axis < 0 || c.time_us <= known_us[static_cast<std::size_t>(axis)] ||
            out.samples_.size() >= most)
          return;
        out.samples_.push_back({estimator::from_microseconds(c.time_us), axis, c.accel_mps2()});
      },
      [&](const drivers::LogEvent& event) {
        if (event.timestamp_us > newest_us) out.messages_.push_back({out.samples_.size(), event});
      }};
  std::string problem;
  out.whole_ = read_raw_history(raw_logs_between(directory, from_us, kEver_us), from_us, kEver_us,
                                visitor, notes, problem);
  if (!problem.empty()) notes.push_back(problem);
  if (!out.samples_.empty())
    out.drop_before(to_microseconds(out.samples_.back().time) - backlog_us(kMost_s));
  if (out.samples_.size() > kMaxSamples)
    out.drop_before(to_microseconds(out.samples_[out.samples_.size() - kMaxSamples].time));
  if (!resumed) out.keep_strong_motion(config);
  return out;
}

void RawBacklog::keep_strong_motion(const Config& config) {
  estimator::PipelineConfig pipeline = config.pipeline;
  std::int64_t began_us = 0;
  estimator::Acquisition acquisition(config.pipeline.axes, config.pipeline.options);
  pipeline.axes = acquisition.axes();
  estimator::ShakingWatch shaking(pipeline, config.event_report->options);
  const auto take = [&](estimator::Acquisition::SampleSets&& sets) {
    for (const estimator::SampleSet& set : sets) {
      (void)shaking.push(set, nullptr);
      if (shaking.began()) began_us = to_microseconds(set.time);
    }
  };
  for (const estimator::AccelSample& sample : samples_) take(acquisition.push(sample));
  take(acquisition.finish());
  if (shaking.active())
    drop_before(began_us - backlog_us(kBefore_s));
  else
    *this = RawBacklog(whole_);
}

double RawBacklog::seconds() const {
  if (samples_.empty()) return 0;
  return 1e-6 * static_cast<double>(to_microseconds(samples_.back().time) - first_us());
}

std::int64_t RawBacklog::first_us() const {
  return samples_.empty() ? 0 : to_microseconds(samples_.front().time);
}

void RawBacklog::drop_before(std::int64_t time_us) {
  const auto first = std::find_if(
      samples_.begin(), samples_.end(),
      [&](const estimator::AccelSample& s) { return to_microseconds(s.time) >= time_us; });
  const auto gone = static_cast<std::size_t>(first - samples_.begin());
  samples_.erase(samples_.begin(), first);
  while (!messages_.empty() && messages_.front().before < gone) messages_.pop_front();
  for (Message& m : messages_) m.before -= gone;
}

}  // namespace framewatch::daemon
