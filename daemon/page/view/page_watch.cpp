// SPDX-License-Identifier: MIT
#include "daemon/page/view/page_watch.h"

#include <algorithm>
#include <optional>

#include <fmt/core.h>

#include "daemon/monitor/estimation/estimation_events.h"
#include "daemon/monitor/events/event_messages.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

estimator::Watch fresh_watch(const estimator::ParameterTable& table,
                             const std::vector<double>& windows_s) {
  estimator::WatchOptions options;
  options.learn_s = PageWatch::kBaseline_s;
  options.least_change_k = PageWatch::kSmallestFrame_ratio;
  options.least_change_g = PageWatch::kSmallestPanel_ratio;
  options.quiet_window_s = 0;
  options.amplitude = false;  // messages lack the amplitude
  return {table, options, windows_s, std::nullopt};
}

}  // namespace

std::vector<std::string> parameter_names(const Config& config) {
  const estimator::ParameterTable table = config.pipeline.parameters();
  std::vector<std::string> out;
  for (int p = 0; p < table.size(); ++p) out.push_back(table[p].name);
  return out;
}

estimator::WindowEstimate decoded_estimate(int window, const window_estimate_t& m) {
  estimator::WindowEstimate e;
  e.window = window;
  e.start = estimator::from_microseconds(m.window_start_us);
  e.end = estimator::from_microseconds(m.window_end_us);
  e.sequence = m.sequence;
  e.status = static_cast<estimator::WindowStatus>(m.status);
  e.value = m.value;
  e.std_error = m.std_error;
  for (const std::int32_t reason : m.reason)
    e.reason.push_back(static_cast<estimator::Observability>(reason));
  e.prior_share.assign(m.prior_share.begin(), m.prior_share.end());
  e.noise_share.assign(m.noise_share.begin(), m.noise_share.end());
  return e;
}

PageWatch::PageWatch(const Config& config, std::int64_t first_id)
    : table_(config.pipeline.parameters()),
      labels_(frame_labels(config.pipeline.structure)),
      windows_s_(window_lengths_s(config.pipeline.options)),
      watch_(fresh_watch(table_, windows_s_)),
      first_id_(first_id) {}

void PageWatch::renew() {
  watch_ = fresh_watch(table_, windows_s_);
  first_id_ += last_alarm_;
  last_alarm_ = 0;
}

std::vector<event_t> PageWatch::observe(int window, const window_estimate_t& estimate) {
  std::vector<event_t> out;
  if (estimate.value.size() != static_cast<std::size_t>(watch_.parameters())) return out;
  for (const estimator::Alarm& alarm : watch_.push(decoded_estimate(window, estimate))) {
    last_alarm_ = std::max(last_alarm_, alarm.id);
    out.push_back(event(alarm));
  }
  return out;
}

std::vector<double> PageWatch::baseline() const {
  std::vector<double> out(static_cast<std::size_t>(watch_.parameters()), estimator::kNaN);
  if (const estimator::Baseline* known = watch_.baseline())
    for (std::size_t p = 0; p < out.size(); ++p)
      if (watch_.watched(p)) out[p] = known->value[p];
  return out;
}

event_t PageWatch::event(const estimator::Alarm& alarm) const {
  const bool over = alarm.state == estimator::AlarmState::cleared;
  event_t e = stiffness_event(alarm, table_, labels_);
  e.id = first_id_ + alarm.id - 1;
  e.severity = over ? severity::information : severity::alarm;
  return e;
}

}  // namespace framewatch::daemon
