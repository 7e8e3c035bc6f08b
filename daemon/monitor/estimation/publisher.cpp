// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimation/publisher.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/core.h>

#include "daemon/config/channel_addresses.h"
#include "daemon/monitor/estimates/estimate_table.h"
#include "daemon/monitor/estimates/parameter_message.h"
#include "drivers/files/encoded.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {

std::vector<std::string> estimate_channels(const Config& config) {
  const std::string main = config.lcm.prefix + "ESTIMATE";
  std::vector<std::string> channels{main};
  for (const double window_s : config.pipeline.options.other_windows_s)
    channels.push_back(fmt::format("{}_{:g}S", main, window_s));
  if (const double window_s = config.pipeline.options.long_window_s; window_s > 0)
    channels.push_back(fmt::format("{}_{:g}S", main, window_s));
  return channels;
}

Publisher::Publisher(const Config& config, MessageSink sink)
    : config_(config), sink_(std::move(sink)), estimate_channels_(estimate_channels(config)) {}

template <typename MessageType>
void Publisher::send(std::int64_t time_us, const std::string& channel, const MessageType& message) {
  if (!sink_) return;
  drivers::encode_into(bytes_, message);
  sink_(time_us, channel, bytes_);
}

void Publisher::parameters(std::int64_t time_us, const estimator::Pipeline& pipeline) {
  parameter_table_t m = parameter_message(config_, pipeline.parameters());
  m.time_us = time_us;
  m.rate_hz = config_.pipeline.options.rate_hz;
  m.window_rows = pipeline.window_rows();
  m.hop_rows = pipeline.hop_rows();
  m.boxplot_windows = config_.pipeline.options.boxplot_windows;
  m.design.assign(pipeline.theta0().begin(), pipeline.theta0().end());
  m.design.resize(m.name.size());
  m.other_channel.assign(estimate_channels_.begin() + 1, estimate_channels_.end());
  m.other_windows = static_cast<std::int32_t>(m.other_channel.size());
  m.other_rows = pipeline.other_window_rows();
  send(time_us, config_.lcm.prefix + "PARAMETERS", m);
}

void Publisher::fill_values(const estimator::WindowEstimate& e) {
  framewatch::window_estimate_t& m = estimate_;
  m.window_start_us = to_microseconds(e.start);
  m.window_end_us = to_microseconds(e.end);
  m.sequence = e.sequence;
  m.status = static_cast<std::int32_t>(e.status);
  m.rows = e.rows;
  m.residual_ratio = e.residual_ratio;
  m.parameters = static_cast<std::int32_t>(e.value.size());
  m.value = e.value;
  m.std_error = e.std_error;
  m.reason.clear();
  for (const estimator::Observability reason : e.reason)
    m.reason.push_back(static_cast<std::int32_t>(reason));
  m.snr.assign(e.snr.begin(), e.snr.end());
  m.prior_share.assign(e.prior_share.begin(), e.prior_share.end());
  m.noise_share.assign(e.noise_share.begin(), e.noise_share.end());
  m.held_index.clear();
  m.held_value.clear();
  m.held_std_error.clear();
  m.held_end_us.clear();
  m.boxplot_windows = m.boxplots = 0;
  for (const BoxColumn& column : kBoxColumns) (m.*column.values).clear();
  m.outliers.clear();
  m.boxplot_count.clear();
  for (std::size_t p = 0; p < e.reason.size() && e.window == 0 && !e.late; ++p) {
    if (e.reason[p] == estimator::Observability::observable || std::isnan(e.last_value[p]))
      continue;
    m.held_index.push_back(static_cast<std::int32_t>(p));
    m.held_value.push_back(e.last_value[p]);
    m.held_std_error.push_back(e.last_std_error[p]);
    m.held_end_us.push_back(to_microseconds(e.last_end[p]));
  }
  m.held = static_cast<std::int32_t>(m.held_index.size());
}

void Publisher::other(const estimator::WindowEstimate& e) {
  if (!sink_) return;
  fill_values(e);
  send(estimate_.window_end_us, estimate_channels_[static_cast<std::size_t>(e.window)], estimate_);
}

void Publisher::estimate(const estimator::WindowEstimate& e) {
  if (!sink_) return;
  fill_values(e);
  framewatch::window_estimate_t& m = estimate_;
  const bool with_boxplot = e.sequence % config_.lcm.boxplot_every == 0;
  m.boxplot_windows = static_cast<std::int32_t>(
      std::min<std::int64_t>(e.sequence + 1, config_.pipeline.options.boxplot_windows));
  m.boxplots = with_boxplot ? static_cast<std::int32_t>(e.boxplot.size()) : 0;
  if (with_boxplot) {
    for (const estimator::BoxplotStatistics& box : e.boxplot) {
      for (const BoxColumn& column : kBoxColumns) (m.*column.values).push_back(box.*column.value);
      m.outliers.push_back(box.outliers);
      m.boxplot_count.push_back(box.count);
    }
  }
  send(m.window_end_us, estimate_channels_.front(), m);
}

void Publisher::late(const estimator::WindowEstimate& e) {
  if (!sink_) return;
  fill_values(e);
  send(estimate_.window_end_us, estimate_channels_[static_cast<std::size_t>(e.window)] + kLate,
       estimate_);
}

void Publisher::event(const event_t& event) {
  send(event.time_us, config_.lcm.prefix + "EVENT", event);
}

void Publisher::watch(std::int64_t time_us, const estimator::Watch& watch) {
  if (!sink_) return;
  watch_t m{};
  const auto count = static_cast<std::size_t>(watch.parameters());
  const estimator::Baseline none(count);
  const estimator::Baseline& usual = watch.baseline() != nullptr ? *watch.baseline() : none;
  const bool known = watch.quiet_baseline() != nullptr;
  const estimator::Baseline& quiet = known ? *watch.quiet_baseline() : none;
  m.time_us = time_us;
  m.long_window_s = watch.options().quiet_window_s;
  m.quiet_learned_ratio = watch.quiet_learned();
  m.temperature_degc = watch.degc(estimator::from_microseconds(time_us));
  m.parameters = static_cast<std::int32_t>(count);
  m.watched.resize(count);
  m.baseline = usual.value;
  m.baseline_std_error = usual.std_error;
  m.baseline_degc = usual.degc;
  m.quiet_baseline = quiet.value;
  m.quiet_std_error = quiet.std_error;
  for (auto* slopes :
       {&m.per_degc, &m.per_degc_std_error, &m.per_log_amplitude, &m.per_log_amplitude_std_error})
    slopes->assign(count, estimator::kNaN);
  for (std::size_t p = 0; p < count; ++p) {
    m.watched[p] = watch.watched(p) ? 1 : 0;
    if (!quiet.knows(p)) continue;
    if (watch.options().temperature) {
      const estimator::Dependence::Slope slope = watch.dependence().per_degc(p);
      m.per_degc[p] = slope.value;
      m.per_degc_std_error[p] = slope.std_error;
    }
    if (watch.options().amplitude) {
      const estimator::Dependence::Slope slope = watch.dependence().per_log(p);
      m.per_log_amplitude[p] = slope.value;
      m.per_log_amplitude_std_error[p] = slope.std_error;
    }
  }
  send(time_us, config_.lcm.prefix + "WATCH", m);
}

void Publisher::weather(const weather_status_t& weather) {
  send(weather.time_us, config_.lcm.prefix + "WEATHER", weather);
}

void Publisher::model(const estimator::ModelFit& fit) {
  if (!sink_) return;
  framewatch::model_fit_t& m = model_;
  m.window_start_us = to_microseconds(fit.start);
  m.window_end_us = to_microseconds(fit.end);
  m.sequence = fit.sequence;
  m.parameters = static_cast<std::int32_t>(fit.word.size());
  m.misfit = fit.misfit;
  m.design_error = fit.design_error;
  m.misfit_error = fit.misfit_error;
  m.corner_error = fit.corner_error;
  m.error = fit.error;
  m.word.clear();
  for (const estimator::FitWord word : fit.word) m.word.push_back(static_cast<std::int32_t>(word));
  send(m.window_end_us, config_.lcm.prefix + "MODEL_FIT", m);
}

void Publisher::gap(const estimator::GapWindow& window) {
  gap_t m{};
  m.window_start_us = to_microseconds(window.start);
  m.window_end_us = to_microseconds(window.end);
  m.overall_nrmse = window.nrmse;
  m.noise_floor = window.floor;
  const std::vector<estimator::SensorAxis>& axes = config_.pipeline.axes;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    if (axes[a].story == 0) continue;
    m.name.push_back(axes[a].name);
    m.nrmse.push_back(window.axis_nrmse[a]);
    m.floor.push_back(window.axis_floor[a]);
  }
  m.channels = static_cast<std::int32_t>(m.name.size());
  send(m.window_end_us, config_.lcm.prefix + "GAP", m);
}

void Publisher::status(status_t m) {
  m.config_sha256 = config_.sha256;
  m.version = FRAMEWATCH_VERSION;
  m.name = axis_names(config_);
  m.channels = static_cast<std::int32_t>(m.name.size());
  send(m.time_us, config_.lcm.prefix + "STATUS", m);
}

}  // namespace framewatch::daemon
