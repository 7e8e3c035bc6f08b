// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimation/gap_files.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/log.h"
#include "daemon/config/channel_addresses.h"
#include "daemon/config/learned_files.h"
#include "drivers/files/caught.h"
#include "drivers/lcm/lcm_log.h"

namespace framewatch::daemon {
namespace {

/// Returns when the file was last written; the epoch if it does not exist.
std::filesystem::file_time_type put_there(const std::string& path) {
  std::error_code none;
  const auto at = std::filesystem::last_write_time(path, none);
  return none ? std::filesystem::file_time_type{} : at;
}

constexpr double kSpare = 1.2;  ///< ring capacity for rates slightly above the nominal one

std::int64_t microseconds(double seconds) {
  return std::llround(1e6 * seconds);
}

/// Writes samples in order of time, those of one time together. Returns an empty string, or the
/// problem.
std::string write_log(drivers::AccelMessages messages, std::size_t axes, const std::string& path,
                      const std::vector<estimator::AccelSample>& samples) {
  drivers::LcmLogWriter log;
  if (!log.open(path)) return log.error();
  const auto put = [&](std::int64_t time_us, const std::vector<drivers::Message>& all) {
    return std::all_of(all.begin(), all.end(), [&](const drivers::Message& m) {
      return log.write(time_us, m.channel, m.bytes.data(), m.bytes.size());
    });
  };
  bool good = samples.empty() || put(to_microseconds(samples.front().time),
                                     messages.tables(to_microseconds(samples.front().time)));
  std::vector<double> values(axes);
  for (std::size_t i = 0; i < samples.size() && good;) {
    const estimator::Time time = samples[i].time;
    std::fill(values.begin(), values.end(), std::numeric_limits<double>::quiet_NaN());
    for (; i < samples.size() && samples[i].time == time; ++i)
      values[static_cast<std::size_t>(samples[i].axis)] = samples[i].accel;
    good = put(to_microseconds(time), messages.samples(to_microseconds(time), values));
  }
  return good && log.close() ? "" : log.error();
}

void log_lost(const std::string& name, const std::string& why) {
  log(LogLevel::error, fmt::format("{}: cannot store the samples of a gap: {}", name, why));
}

void store_segment(drivers::AccelMessages messages, std::size_t axes, const std::string& store,
                   const std::string& name, std::vector<estimator::AccelSample>& samples) {
  std::ranges::stable_sort(samples, {}, &estimator::AccelSample::time);
  std::error_code failure;
  std::filesystem::create_directories(store, failure);
  const std::string path = (std::filesystem::path(store) / name).string();
  const std::string problem =
      failure ? failure.message() : write_log(std::move(messages), axes, path, samples);
  if (!problem.empty()) return log_lost(path, problem);
  log(LogLevel::notice, fmt::format("samples of the gap are in {}", path));
}

}  // namespace

GapKeeper::GapKeeper(const Config& config) : config_(&config) {
  if (config.gap && !config.gap->model_path.empty()) seen_ = put_there(config.gap->model_path);
}

void GapKeeper::poll(Estimation& estimation, std::int64_t now_us) {
  if (!config_->gap || config_->gap->model_path.empty() || !second_.due(now_us)) return;
  const std::string& path = config_->gap->model_path;
  const auto at = put_there(path);
  if (at == std::exchange(seen_, at) || at == std::filesystem::file_time_type{}) return;
  std::vector<ConfigProblem> problems;
  if (const auto model = load_gap_model_file(*config_, path, problems)) {
    estimation.adopt(*model);
    log(LogLevel::notice, fmt::format("adopted {}: {} effects", path, model->effects.size()));
  }
  for (const ConfigProblem& p : problems)
    log(LogLevel::error, fmt::format("not adopted: {}: {}", p.where, p.message));
}

GapSegments::GapSegments(const Config& config) : config_(config) {
  if (!config.gap || config.gap->store.empty()) return;
  const double seconds = config.gap->before_s + config.gap->after_s + config.gap->options.lasting_s;
  ring_.resize(
      static_cast<std::size_t>(std::ceil(kSpare * seconds * config.pipeline.options.rate_hz *
                                         static_cast<double>(config.pipeline.axes.size()))));
}

GapSegments::~GapSegments() {
  if (waiting_ != 0) write();
}

void GapSegments::sample(const estimator::AccelSample& sample) {
  if (ring_.empty()) return;
  ring_[next_] = sample;
  next_ = (next_ + 1) % ring_.size();
  held_ = std::min(held_ + 1, ring_.size());
  newest_us_ = to_microseconds(sample.time);
  if (waiting_ != 0 && newest_us_ - raised_us_ >= microseconds(config_.gap->after_s)) write();
}

void GapSegments::raised(std::int64_t gap_id) {
  if (ring_.empty()) return;
  if (waiting_ != 0) write();
  waiting_ = gap_id;
  raised_us_ = newest_us_;
}

void GapSegments::write() {
  if (writing_.valid()) writing_.wait();
  const std::int64_t from_us = raised_us_ - microseconds(config_.gap->before_s);
  std::vector<estimator::AccelSample> samples;
  for (std::size_t i = 0; i < held_; ++i) {
    const estimator::AccelSample& s = ring_[(next_ + ring_.size() - held_ + i) % ring_.size()];
    if (to_microseconds(s.time) >= from_us) samples.push_back(s);
  }
  const std::string name = segment_name(config_, std::exchange(waiting_, 0));
  const std::string thrown = drivers::caught([&] {
    writing_ = std::async(
        std::launch::async, [messages = accel_messages(config_, config_.pipeline.options.rate_hz),
                             axes = config_.pipeline.axes.size(), store = config_.gap->store, name,
                             samples = std::move(samples)]() mutable {
          const std::string why = drivers::caught(
              [&] { store_segment(std::move(messages), axes, store, name, samples); });
          if (!why.empty()) log_lost(name, why);
        });
  });
  if (!thrown.empty()) log_lost(name, thrown);
}

}  // namespace framewatch::daemon
