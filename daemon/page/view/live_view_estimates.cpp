// LiveView takes in the parameters and windows that an estimator publishes, and looks for changes.
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <framewatch/event_t.hpp>
#include <framewatch/watch_t.hpp>

#include "daemon/monitor/estimation/publisher.h"
#include "daemon/page/view/live_view.h"
#include "drivers/files/encoded.h"
#include "drivers/lcm/message_check.h"

namespace framewatch::daemon {
void LiveView::parameters(std::span<const std::uint8_t> bytes) {
  const auto table = drivers::decoded<parameter_table_t>(bytes);
  if (!table || table->name == parameters_) return;
  parameters_ = table->name;
  watch_.reset();
  // An estimator of another building's configuration is shown, not watched.
  same_parameters_ = parameters_ == parameter_names(config_);
  if (same_parameters_) watch_.emplace(config_, std::max<std::int64_t>(1, table->time_us));
}

void LiveView::estimate(const std::string& channel, std::span<const std::uint8_t> bytes) {
  const auto at = std::find(estimate_channels_.begin(), estimate_channels_.end(), channel);
  if (at == estimate_channels_.end()) return;
  auto found = drivers::decoded<window_estimate_t>(bytes);
  // Arithmetic on the times of others stays exact.
  if (!found || found->window_end_us > drivers::kLatestTime_us ||
      found->window_end_us < -drivers::kLatestTime_us)
    return;
  const auto window = static_cast<int>(at - estimate_channels_.begin());
  look_for_changes(window, *found);
  if (window != 0) return;
  new_estimate_ = true;
  estimate_at_ = flushes_;
  fit_.push(*found);
  if (found->value.size() == parameters_.size() && same_parameters_)
    shaking_.follow(decoded_estimate(window, *found));
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    history_.estimate(*found);
  }
  newest_ = std::move(*found);
}

void LiveView::late_estimate(std::span<const std::uint8_t> bytes) {
  const auto found = drivers::decoded<window_estimate_t>(bytes);
  if (!found) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  late_rows_ = history_.late(*found) || late_rows_;
}

void LiveView::look_for_changes(int window, const window_estimate_t& estimate) {
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
  if (told_watch_ && told_watch_->baseline.size() == parameters_.size())
    return told_watch_->baseline;
  return watch_ && !config_.watch ? watch_->baseline() : std::vector<double>{};
}

bool LiveView::watched(std::size_t parameter) const {
  if (told_watch_ && parameter < told_watch_->watched.size())
    return told_watch_->watched[parameter] != 0;
  return watch_ && watch_->watched(parameter);
}

}  // namespace framewatch::daemon
