#include "daemon/change_watch.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "estimator/structure/nan.h"

namespace framewatch::daemon {
namespace {

constexpr int kWithinToClear = 10;

}  // namespace

ChangeWatch::ChangeWatch(const parameter_table_t& table, double window_s, std::int64_t first_id)
    : table_(table), window_s_(window_s), next_id_(first_id) {
  renew();
}

void ChangeWatch::renew() {
  baseline_.assign(table_.name.size(), kNaN);
  watched_.assign(table_.name.size(), {});
}

event_t ChangeWatch::event(std::size_t p, int state, std::int64_t time_us, double change,
                           double error) const {
  event_t e{};
  e.time_us = time_us;
  e.since_us = watched_[p].since_us;
  e.id = watched_[p].id;
  e.state = state;
  e.severity = state == 0 ? 0 : 2;
  e.kind = "stiffness_change";
  e.place = table_.name[p];
  e.value = change;
  e.std_error = error;
  e.unit = "ratio";
  e.message = state == 0 ? fmt::format("{} is back at its baseline", table_.name[p])
                         : fmt::format("{} is {:+.1f} % from its baseline, standard error {:.1f} %",
                                       table_.name[p], 100 * change, 100 * error);
  return e;
}

std::vector<event_t> ChangeWatch::observe(const window_estimate_t& e) {
  std::vector<event_t> out;
  const std::size_t count = std::min(watched_.size(), e.value.size());
  for (std::size_t p = 0; p < count; ++p) {
    Watched& w = watched_[p];
    if (table_.kind[p] > 1 || e.reason[p] != 0 || !std::isfinite(e.value[p])) continue;
    if (!std::isfinite(baseline_[p])) {
      if (w.count++ == 0) w.first_us = e.window_end_us;
      w.sum += e.value[p];
      w.squares += e.std_error[p] * e.std_error[p];
      const double seconds = 1e-6 * static_cast<double>(e.window_end_us - w.first_us);
      if (seconds < kBaseline_s) continue;
      baseline_[p] = w.sum / w.count;
      w.error = std::sqrt(w.squares / w.count / std::max(1.0, seconds / window_s_)) / baseline_[p];
      continue;
    }
    const double change = e.value[p] / baseline_[p] - 1;
    const double error = std::hypot(e.std_error[p] / baseline_[p], w.error);
    const double limit = std::max(kSmallest_ratio, kSigma * error);
    if (std::abs(change) > limit) {
      if (w.beyond++ == 0 && w.id == 0) w.since_us = e.window_end_us;
      w.within = 0;
    } else {
      w.beyond = 0;
      w.within = std::abs(change) < 0.5 * limit ? w.within + 1 : 0;
    }
    if (w.id == 0 && w.beyond >= kInARow) {
      w.id = next_id_++;
      w.told = change;
      w.told_error = error;
      out.push_back(event(p, 1, e.window_end_us, change, error));
    } else if (w.id != 0 && w.within >= kWithinToClear) {
      out.push_back(event(p, 0, e.window_end_us, change, error));
      w.id = 0;
    } else if (w.id != 0 && w.beyond > 0 &&
               (std::abs(change - w.told) > kNews_ratio || error < kSurer_ratio * w.told_error)) {
      w.told = change;
      w.told_error = error;
      out.push_back(event(p, 2, e.window_end_us, change, error));
    }
  }
  return out;
}

}  // namespace framewatch::daemon
