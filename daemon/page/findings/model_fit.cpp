#include "daemon/page/findings/model_fit.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "daemon/monitor/events/event_messages.h"

namespace framewatch::daemon {
namespace {

constexpr int kIdentifies = 1;  // window_estimate_t::status

}  // namespace

void ModelFit::push(const window_estimate_t& e) {
  const double step_s =
      std::clamp(1e-6 * static_cast<double>(e.window_end_us - last_us_), 0.0, 1.0);
  last_us_ = e.window_end_us;
  const bool shown = e.status == kIdentifies && std::isfinite(e.residual_ratio) &&
                     std::find(e.reason.begin(), e.reason.end(), 0) != e.reason.end();
  if (!shown) return;
  const double square = e.residual_ratio * e.residual_ratio;
  seconds_ = std::min(seconds_ + step_s, kMean_s);
  mean_ += (seconds_ > 0 ? std::min(1.0, step_s / seconds_) : 1) * (square - mean_);
  if (seconds_ < kMean_s) return;
  const double residual = std::sqrt(mean_);
  if (fits_ && residual > kMax) {
    fits_ = false;
    since_us_ = e.window_end_us - static_cast<std::int64_t>(1e6 * kMean_s);
  } else if (!fits_ && residual < kAgain) {
    fits_ = true;
  }
}

std::optional<double> ModelFit::residual() const {
  if (seconds_ <= 0) return std::nullopt;
  return std::sqrt(mean_);
}

std::optional<Finding> ModelFit::finding() const {
  if (fits_) return std::nullopt;
  Finding f;
  f.kind = FindingKind::belief;
  f.severity = severity::warning;
  f.since_us = since_us_;
  f.text = fmt::format("The model does not fit: it leaves {:.0f} % of the motion unexplained.",
                       100 * std::sqrt(mean_));
  f.advice = "Find out what the model lacks: framewatch diagnose, with a record of this motion.";
  return f;
}

}  // namespace framewatch::daemon
